# SPDX-License-Identifier: Apache-2.0
"""What the tests of the live page share: one robot for all tests of a class, and a browser for each."""

import unittest

from running_daemon import ROOT, RunningDaemon
from webdriver import Browser

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

    def open(self, width=1280, height=800, mobile=False, dark=False):
        browser = Browser(width, height, dark, mobile)
        self.addCleanup(browser.__exit__)
        browser.open(self.daemon.page())
        for condition in self.ready:
            browser.wait(condition)
        return browser
