# SPDX-License-Identifier: Apache-2.0
"""What the tests of the live page share: one robot for all tests of a class, and a browser for each."""

import time
import unittest

from browser import Browser
from running_daemon import ROOT, RunningDaemon

PICTURES = ROOT / "build/browser"
SIZES = {"phone": (390, 844, True), "netbook": (1024, 600, False), "desk": (1920, 1080, False)}
SHOWS_MAP = "window.deltamap?.model.revision !== undefined && window.deltamap.view.tiles.size > 0 && window.deltamap.model.scan"


class PageCase(unittest.TestCase):
    """`robot`: how it and its daemon are begun. `ready`: what a page that was opened waits for."""

    robot = {"change_every_s": 10}
    ready = (SHOWS_MAP,)

    @classmethod
    def setUpClass(cls):
        PICTURES.mkdir(parents=True, exist_ok=True)
        cls.daemon = RunningDaemon(token="of-the-browser-tests", **cls.robot)

    @classmethod
    def tearDownClass(cls):
        cls.daemon.__exit__()

    def click(self, browser, selector):
        browser.execute_script("document.querySelector(arguments[0]).click()", selector)

    def choose(self, browser, label):
        """One of the answers to a question over the map."""
        browser.wait(f"[...document.querySelectorAll('.task-buttons button')].some((one) => one.textContent === '{label}')")
        browser.execute_script("[...document.querySelectorAll('.task-buttons button')].find((one) => one.textContent === arguments[0]).click()", label)

    def until(self, condition, patience_s=10):
        give_up_at = time.monotonic() + patience_s
        while not condition():
            self.assertLess(time.monotonic(), give_up_at)
            time.sleep(0.05)

    def expect_in_sight(self, browser, what):
        """A place of the map, [x, y] of an expression: nothing covers it."""
        browser.wait(f"""(() => {{
            const {{ view, model }} = window.deltamap, box = view.canvas.getBoundingClientRect(), [x, y] = view.to_screen(...{what});
            return document.elementFromPoint(box.left + x, box.top + y) === view.canvas;
        }})()""", 3)

    def open(self, width=1280, height=800, mobile=False, dark=False):
        browser = Browser(width, height, dark, mobile)
        self.addCleanup(browser.quit)
        browser.get(self.daemon.page())
        for condition in self.ready:
            browser.wait(condition)
        return browser
