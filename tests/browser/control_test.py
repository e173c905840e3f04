#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""What the live page commands, in Chromium, with a simulated robot behind it: ./dev test browser."""

import math
import time
import unittest

from page_case import PICTURES, SHOWS_MAP, SIZES, PageCase

UP, LEFT, ESCAPE, ENTER = "\ue013", "\ue012", "\ue00c", "\ue007"
SHIFT, CONTROL = "\ue008", "\ue009"
HAS_CONTROL = '!document.querySelector("#controls").hidden'
TASK = 'document.querySelector("#task .task-text").textContent'
IS_TAKEN = '!document.querySelector("#pad").hidden'
# What lies on top at the middle of an element.
ON_TOP = """const box = document.querySelector(arguments[0]).getBoundingClientRect();
return document.elementFromPoint(box.left + box.width / 2, box.top + box.height / 2)?.closest("button")?.id;"""


class ControlTest(PageCase):
    """One robot for all; each test finds it wandering."""

    robot = {"change_every_s": 300}
    ready = (SHOWS_MAP, HAS_CONTROL, "window.deltamap.model.status")

    def setUp(self):
        self.daemon.ctl("drive", "off")  # out of whose hand ever
        self.until(lambda: self.daemon.ctl("drive", "wander").returncode == 0, 30)

    def click(self, browser, selector):
        browser.run("document.querySelector(arguments[0]).click()", selector)

    def choose(self, browser, label):
        browser.wait(f"[...document.querySelectorAll('.task-buttons button')].some((one) => one.textContent === '{label}')")
        browser.run("[...document.querySelectorAll('.task-buttons button')].find((one) => one.textContent === arguments[0]).click()", label)

    def until(self, condition, patience_s=10):
        give_up_at = time.monotonic() + patience_s
        while not condition():
            self.assertLess(time.monotonic(), give_up_at)
            time.sleep(0.05)

    def is_still(self):
        """Over a whole second."""
        before = self.daemon.status()["pose"]
        time.sleep(1)
        after = self.daemon.status()["pose"]
        return math.hypot(after["x_m"] - before["x_m"], after["y_m"] - before["y_m"]) < 0.02

    def take_in_hand(self, browser):
        self.click(browser, "#drive")
        self.choose(browser, "Drive by hand")
        browser.wait(IS_TAKEN)
        self.assertEqual(self.daemon.status()["drive"], "by hand")

    def test_pause_and_resume(self):
        browser = self.open()
        self.assertEqual(browser.run("return document.querySelector('#pause').textContent"), "Pause mapping")
        self.click(browser, "#pause")
        self.until(lambda: self.daemon.status()["mapping"] == "paused")
        browser.wait("document.querySelector('#pause').textContent === 'Resume mapping'")
        self.click(browser, "#pause")
        self.until(lambda: self.daemon.status()["mapping"] == "on")
        self.assertEqual(browser.errors(), [])

    def test_save_says_where(self):
        browser = self.open()
        self.click(browser, "#save")
        browser.wait(f"{TASK}.includes('store.saved.yaml')")
        self.assertTrue((self.daemon.place / "store.saved.yaml").exists())

    def test_stop_is_in_sight_at_every_size_and_stops(self):
        for name, (width, height, mobile) in SIZES.items():
            with self.subTest(size=name):
                browser = self.open(width, height, mobile)
                self.assertEqual(browser.run(ON_TOP, "#stop"), "stop")
                browser.run("scrollTo(0, 100000)")
                self.assertEqual(browser.run(ON_TOP, "#stop"), "stop")
                browser.run("scrollTo(0, 0)")
                self.click(browser, "#relocalize")
                self.assertEqual(browser.run(ON_TOP, "#stop"), "stop")
                self.click(browser, "#stop")
                browser.wait(f"{TASK}.startsWith('STOP: the robot is told to stand')")
                self.assertEqual(self.daemon.status()["drive"], "off")
                self.until(self.is_still)
                self.daemon.ctl("drive", "wander")
                self.assertEqual(browser.errors(), [])

    def test_relocalize_by_drag_shows_how_the_scan_fits(self):
        browser = self.open()
        self.click(browser, "#stop")
        self.until(self.is_still)
        browser.run("window.deltamap.view.show(window.deltamap.model.pose.x_m, window.deltamap.model.pose.y_m)")
        self.click(browser, "#relocalize")
        wrong = self.drag_from_robot(browser, math.pi / 2)
        right = self.drag_from_robot(browser, 0)
        browser.screenshot(PICTURES / "relocalize.png")
        self.assertGreater(right, wrong + 20)
        self.assertGreater(right, 60)
        self.choose(browser, "Relocalize here")
        browser.wait("document.querySelector('#task').dataset.level === 'good'")
        self.assertIn("beams", browser.run(f"return {TASK}"))
        self.assertEqual(browser.errors(), [])

    def drag_from_robot(self, browser, turned_rad):
        """Presses where the robot is; the share that is told, in percent."""
        start, end = browser.run("""const { view, model } = window.deltamap, box = view.canvas.getBoundingClientRect(), pose = model.pose;
            const [x, y] = view.to_screen(pose.x_m, pose.y_m), heading = pose.heading_rad + arguments[0];
            return [[x, y], [x + 90 * Math.cos(heading), y - 90 * Math.sin(heading)]].map(([px, py]) => [Math.round(box.left + px), Math.round(box.top + py)])""",
                                 turned_rad)
        browser.drag(start, end)
        told = browser.run(f"return {TASK}")
        self.assertIn("% of the beam ends on obstacles", told)
        return int(told.split(": ")[1].split(" %")[0])

    def test_relocalize_by_keys_and_escape(self):
        browser = self.open()
        self.click(browser, "#relocalize")
        browser.press("#map", UP)
        browser.press("#map", ",")
        browser.wait("window.deltamap.model.wish")
        browser.press("#map", ESCAPE)
        browser.wait("!window.deltamap.model.wish && document.querySelector('#task').hidden")
        before = browser.run("return window.deltamap.view.centre.y")
        browser.press("#map", UP)
        self.assertGreater(browser.run("return window.deltamap.view.centre.y"), before)

    def test_keys_drive_and_releasing_stops(self):
        browser = self.open()
        self.click(browser, "#stop")
        self.until(self.is_still)
        self.take_in_hand(browser)
        self.assertTrue(self.is_still())
        before = browser.run("return window.deltamap.model.pose.heading_rad")
        browser.keys(("down", LEFT), ("wait", 1.5))
        browser.screenshot(PICTURES / "drive.png")
        browser.keys(("up", LEFT))
        turned = abs(math.remainder(browser.run("return window.deltamap.model.pose.heading_rad") - before, 2 * math.pi))
        self.assertGreater(turned, 0.2)
        self.until(self.is_still)
        self.assertEqual(self.daemon.status()["drive"], "by hand")
        browser.keys(("down", ESCAPE), ("up", ESCAPE))
        self.until(lambda: self.daemon.status()["drive"] == "off")
        self.assertEqual(self.daemon.status()["drive_switch"], "off by the operator")
        self.assertEqual(browser.errors(), [])

    def test_a_hidden_page_a_closed_one_and_a_lost_focus_let_go(self):
        for name, leave in {
            "hidden": lambda browser: browser.run("""Object.defineProperty(document, "hidden", { value: true, configurable: true });
                                                     document.dispatchEvent(new Event("visibilitychange"))"""),
            "left": lambda browser: browser.open("about:blank"),
            "closed": lambda browser: browser.__exit__(),
        }.items():
            with self.subTest(name):
                browser = self.open()
                self.take_in_hand(browser)
                browser.keys(("down", LEFT))
                leave(browser)
                self.until(lambda: self.daemon.status()["drive"] == "off", 2)
                self.until(self.is_still)
        browser = self.open()
        self.take_in_hand(browser)
        browser.keys(("down", LEFT))
        browser.wait("window.deltamap.control.hand.held.size === 1")
        browser.run("dispatchEvent(new Event('blur'))")
        self.assertEqual(browser.run("return window.deltamap.control.hand.held.size"), 0)
        self.until(self.is_still)

    def test_a_key_that_goes_up_under_a_modifier_is_released(self):
        held = "return window.deltamap.control.hand.held.size"
        browser = self.open()
        self.take_in_hand(browser)
        for key, modifier in (UP, CONTROL), ("w", SHIFT):
            with self.subTest(key):
                browser.keys(("down", key))
                self.assertEqual(browser.run(held), 1)
                browser.keys(("down", modifier), ("up", key))
                self.assertEqual(browser.run(held), 0)
                browser.keys(("up", modifier))
        browser.keys(("down", UP), ("down", CONTROL))
        self.assertEqual(browser.run(held), 0)
        self.until(self.is_still)

    def test_nothing_to_command_where_control_is_off(self):
        browser = self.open()
        browser.run("window.deltamap.control.allow(null)")
        self.assertTrue(browser.run("return document.querySelector('#controls').hidden"))
        browser.run("window.deltamap.control.allow({ drive: false })")
        self.assertTrue(browser.run("return document.querySelector('#drive').hidden && !document.querySelector('#stop').hidden"))


if __name__ == "__main__":
    unittest.main(verbosity=2)
