#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""What the live page commands, in Chromium, with a simulated robot behind it: ./dev test browser."""

import math
import time
import unittest

from selenium.webdriver import ActionChains
from selenium.webdriver.common.keys import Keys

from browser import Browser
from page_case import PICTURES, SHOWS_MAP, SIZES, PageCase

UP, LEFT, ESCAPE, ENTER = Keys.ARROW_UP, Keys.ARROW_LEFT, Keys.ESCAPE, Keys.ENTER
SHIFT, CONTROL = Keys.SHIFT, Keys.CONTROL
HAS_CONTROL = '!document.querySelector("#controls").hidden'
TASK = 'document.querySelector("#task .task-text").textContent'
STATUS_S = 0.1  # until a status has been asked for and read
IS_TAKEN = '!document.querySelector("#pad").hidden'
# What lies on top at the middle of an element.
ON_TOP = """const box = document.querySelector(arguments[0]).getBoundingClientRect();
return document.elementFromPoint(box.left + box.width / 2, box.top + box.height / 2)?.closest("button")?.id;"""


class ControlTest(PageCase):
    """One robot for all; each test finds it wandering."""

    robot = {"change_every_s": 300, "places": {"recording.file": "drive.pcapng"}}
    ready = (SHOWS_MAP, HAS_CONTROL, "window.deltamap.model.status")

    def setUp(self):
        self.daemon.ctl("drive", "off")  # out of whose hand ever
        self.until(lambda: self.daemon.ctl("drive", "wander").returncode == 0, 30)

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
        self.assertEqual(browser.execute_script("return document.querySelector('#pause').textContent"), "Pause mapping")
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

    def test_the_recording_is_stopped_and_goes_on(self):
        browser = self.open()
        for label, goes_on in (("Stop recording", False), ("Record", True)):
            browser.wait(f"document.querySelector('#record').textContent === '{label}'")
            self.click(browser, "#record")
            self.until(lambda: self.daemon.status()["recording"]["goes_on"] == goes_on)
        browser.wait("document.querySelector('#record').textContent === 'Stop recording'")
        self.assertEqual(browser.errors(), [])

    def test_without_the_token_the_page_is_read_and_asks_for_it_to_command(self):
        browser = Browser()
        self.addCleanup(browser.quit)
        browser.get(self.daemon.url)
        browser.wait(SHOWS_MAP)
        browser.wait("!document.querySelector('#unlock').hidden")
        seen = browser.execute_script("return [...document.querySelectorAll('#controls button')].filter((one) => one.checkVisibility()).map((one) => one.id)")
        self.assertEqual(sorted(seen), ["stop", "unlock"])
        self.assertTrue(all("401" in line for line in browser.errors()))
        self.click(browser, "#stop")
        browser.wait(f"{TASK}.startsWith('STOP: the robot is told to stand')")
        self.assertEqual(self.daemon.status()["drive"], "off")
        self.click(browser, "#unlock")
        browser.execute_script("document.querySelector('#task input').value = arguments[0]", self.daemon.token)
        self.choose(browser, "Unlock")
        browser.wait(SHOWS_MAP)
        browser.wait("document.querySelector('#unlock').hidden && document.querySelector('#stop').checkVisibility()")
        self.click(browser, "#save")
        browser.wait(f"{TASK}.includes('store.saved.yaml')")
        self.assertEqual(browser.errors(), [])

    def test_stop_is_in_sight_at_every_size_and_stops(self):
        for name, (width, height, mobile) in SIZES.items():
            with self.subTest(size=name):
                browser = self.open(width, height, mobile)
                self.assertEqual(browser.execute_script(ON_TOP, "#stop"), "stop")
                browser.execute_script("scrollTo(0, 100000)")
                self.assertEqual(browser.execute_script(ON_TOP, "#stop"), "stop")
                browser.execute_script("scrollTo(0, 0)")
                self.click(browser, "#relocalize")
                self.assertEqual(browser.execute_script(ON_TOP, "#stop"), "stop")
                self.click(browser, "#stop")
                browser.wait(f"{TASK}.startsWith('STOP: the robot is told to stand')")
                self.assertEqual(self.daemon.status()["drive"], "off")
                self.until(self.is_still)
                self.daemon.ctl("drive", "wander")
                self.assertEqual(browser.errors(), [])

    def test_relocalize_by_drag_shows_how_the_scan_fits_and_moves_the_robot(self):
        browser = self.open()
        self.click(browser, "#stop")
        self.until(self.is_still)
        there = browser.execute_script("const { x_m, y_m, heading_rad } = window.deltamap.model.pose; return [x_m, y_m, heading_rad]")
        x, y, heading = there
        # A pose that is merely shifted may be mended by the very next scan; one that is turned is not.
        for name, wish, level in (("turned", (x, y, heading + math.pi / 2), "warn"), ("put back", there, "good")):
            with self.subTest(name):
                self.click(browser, "#relocalize")
                fit = self.drag_to(browser, wish)
                browser.save_screenshot(PICTURES / f"relocalize-{level}.png")
                self.assertTrue(fit > 60 if level == "good" else fit < 40, fit)
                self.choose(browser, "Relocalize here")
                browser.wait(f"document.querySelector('#task').dataset.level === '{level}'")
                self.assertIn("beams", browser.execute_script(f"return {TASK}"))
                browser.wait(f"Math.cos(window.deltamap.model.pose.heading_rad - {wish[2]}) > 0.98", 5)
        put_back = browser.execute_script("const { x_m, y_m } = window.deltamap.model.pose; return [x_m, y_m]")
        self.assertLess(math.dist(put_back, (x, y)), 0.2)
        self.assertEqual(browser.errors(), [])

    def drag_to(self, browser, wish):
        """Presses where the robot shall be and drags to where it shall look; the share that is told, in percent."""
        start, end = browser.execute_script("""const { view } = window.deltamap, [x, y, heading] = arguments[0];
            view.show(x, y);
            const box = view.canvas.getBoundingClientRect(), [px, py] = view.to_screen(x, y);
            return [[px, py], [px + 90 * Math.cos(heading), py - 90 * Math.sin(heading)]].map(([px, py]) => [Math.round(box.left + px), Math.round(box.top + py)])""",
                                 wish)
        browser.hand({0: start}, {0: "down"}, {0: end}, {0: "up"})
        told = browser.execute_script(f"return {TASK}")
        self.assertIn("% of the beams fit the map", told)
        return int(told.split(": ")[1].split(" %")[0])

    def test_what_is_wished_is_in_sight_at_every_size(self):
        for name in ("phone", "netbook"):
            with self.subTest(size=name):
                browser = self.open(*SIZES[name])
                self.click(browser, "#relocalize")
                for _ in range(3):
                    browser.press("#map", Keys.ARROW_DOWN)
                browser.execute_script("const { view, model } = window.deltamap; view.show(model.wish.x, model.wish.y); view.move_by(0, 400)")
                browser.press("#map", UP)
                self.expect_in_sight(browser, "[model.wish.x, model.wish.y]")
                browser.save_screenshot(PICTURES / f"wish-{name}.png")
                self.assertEqual(browser.errors(), [])

    def test_relocalize_by_keys_and_escape(self):
        browser = self.open()
        self.click(browser, "#relocalize")
        browser.press("#map", UP)
        browser.press("#map", ",")
        browser.wait("window.deltamap.model.wish")
        browser.press("#map", ESCAPE)
        browser.wait("!window.deltamap.model.wish && document.querySelector('#task').hidden")
        before = browser.execute_script("return window.deltamap.view.centre.y")
        browser.press("#map", UP)
        self.assertGreater(browser.execute_script("return window.deltamap.view.centre.y"), before)

    def test_keys_drive_and_releasing_stops(self):
        browser = self.open()
        self.click(browser, "#stop")
        self.until(self.is_still)
        self.take_in_hand(browser)
        self.assertTrue(self.is_still())
        before = browser.execute_script("return window.deltamap.model.pose.heading_rad")
        ActionChains(browser).key_down(LEFT).pause(1.5).perform()
        browser.save_screenshot(PICTURES / "drive.png")
        ActionChains(browser).key_up(LEFT).perform()
        turned = abs(math.remainder(browser.execute_script("return window.deltamap.model.pose.heading_rad") - before, 2 * math.pi))
        self.assertGreater(turned, 0.2)
        self.until(self.is_still)
        self.assertEqual(self.daemon.status()["drive"], "by hand")
        ActionChains(browser).key_down(ESCAPE).key_up(ESCAPE).perform()
        self.until(lambda: self.daemon.status()["drive"] == "off")
        self.assertEqual(self.daemon.status()["drive_switch"], "off by the operator")
        self.assertEqual(browser.errors(), [])

    def test_the_stick_drives_and_turns_and_letting_go_stops(self):
        browser = self.open()
        self.click(browser, "#stop")
        self.until(self.is_still)
        self.take_in_hand(browser)
        x, y = browser.execute_script("const box = document.querySelector('#stick').getBoundingClientRect(); return [Math.round(box.left + box.width / 2), Math.round(box.top + box.height / 2)]")
        told = lambda: self.daemon.status()["told"]
        browser.hand({0: (x, y)}, {0: "down"}, {0: (x - 20, y - 30)})
        self.until(lambda: told()["turn_rate_rad_per_s"] > 0.1)
        self.until(lambda: told()["speed_m_per_s"] > 0.05 or self.daemon.status()["stopped_by"] == "obstacle")
        browser.save_screenshot(PICTURES / "stick.png")
        browser.hand({0: "up"})
        let_go = time.monotonic()
        self.until(lambda: told() == {"speed_m_per_s": 0, "turn_rate_rad_per_s": 0})
        self.assertLess(time.monotonic() - let_go, 0.3 + STATUS_S)
        for name, end in (("capture", "document.querySelector('#stick').releasePointerCapture(window.deltamap.control.hand.pull.pointer)"),
                          ("focus", "dispatchEvent(new Event('blur'))")):
            with self.subTest(lost=name):
                browser.hand({0: (x, y)}, {0: "down"}, {0: (x + 25, y)})
                self.until(lambda: told()["turn_rate_rad_per_s"] < -0.1)
                browser.execute_script(end)
                self.until(lambda: told()["turn_rate_rad_per_s"] == 0, 1)
                browser.hand({0: (x - 25, y)})  # what is still down means nothing until it is pressed anew
                self.assertIsNone(browser.execute_script("return window.deltamap.control.hand.pull"))
                browser.hand({0: "up"})
        self.assertEqual(browser.errors(), [])

    def test_a_hidden_page_a_closed_one_and_a_lost_focus_let_go(self):
        for name, leave in {
            "hidden": lambda browser: browser.execute_script("""Object.defineProperty(document, "hidden", { value: true, configurable: true });
                                                                document.dispatchEvent(new Event("visibilitychange"))"""),
            "left": lambda browser: browser.get("about:blank"),
            "closed": lambda browser: browser.quit(),
        }.items():
            with self.subTest(name):
                browser = self.open()
                self.take_in_hand(browser)
                ActionChains(browser).key_down(LEFT).perform()
                leave(browser)
                self.until(lambda: self.daemon.status()["drive"] == "off", 2)
                self.until(self.is_still)
        browser = self.open()
        self.take_in_hand(browser)
        ActionChains(browser).key_down(LEFT).perform()
        browser.wait("window.deltamap.control.hand.held.size === 1")
        browser.execute_script("dispatchEvent(new Event('blur'))")
        self.assertEqual(browser.execute_script("return window.deltamap.control.hand.held.size"), 0)
        self.until(self.is_still)

    def test_a_key_that_goes_up_under_a_modifier_is_released(self):
        held = "return window.deltamap.control.hand.held.size"
        browser = self.open()
        self.take_in_hand(browser)
        for key, modifier in (UP, CONTROL), ("w", SHIFT):
            with self.subTest(key):
                ActionChains(browser).key_down(key).perform()
                self.assertEqual(browser.execute_script(held), 1)
                ActionChains(browser).key_down(modifier).key_up(key).perform()
                self.assertEqual(browser.execute_script(held), 0)
                ActionChains(browser).key_up(modifier).perform()
        ActionChains(browser).key_down(UP).key_down(CONTROL).perform()
        self.assertEqual(browser.execute_script(held), 0)
        self.until(self.is_still)

    def test_nothing_to_command_where_control_is_off(self):
        browser = self.open()
        browser.execute_script("return window.deltamap.control.allow(null)")
        self.assertTrue(browser.execute_script("return document.querySelector('#controls').hidden"))
        browser.execute_script("return window.deltamap.control.allow({ drive: false })")
        self.assertTrue(browser.execute_script("return document.querySelector('#drive').hidden && !document.querySelector('#stop').hidden"))


if __name__ == "__main__":
    unittest.main(verbosity=2)
