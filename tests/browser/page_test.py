#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The live page in Chromium, with a simulated robot behind it: ./dev test browser. Screenshots go to build/browser."""

import json
import os
import shutil
import signal
import time
import unittest

from selenium.webdriver.common.keys import Keys

from browser import Browser
from page_case import PICTURES, SHOWS_MAP, SIZES, PageCase
from running_daemon import ROOT

IS_LIVE = 'document.body.dataset.link === "live"'
# Cells of a box of the map (centre and sides, m) that the page shows as free, as a share.
FREE_SHARE = """
const [x, y, wide, high] = arguments[0], { view } = window.deltamap, m = view.frame.resolution_m;
let free = 0, all = 0;
for (let px = x - wide / 2 + m; px < x + wide / 2 - m; px += m) {
  for (let py = y - high / 2 + m; py < y + high / 2 - m; py += m) {
    ++all;
    if (view.state_near(px, py, 0) === 0) ++free;
  }
}
return free / all;"""
# Pixels of the map's canvas that differ from the first one: something is drawn.
DRAWN = """
const canvas = document.querySelector("#map"), { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
const colours = new Set();
for (let i = 0; i < data.length; i += 64) colours.add(data[i] << 16 | data[i + 1] << 8 | data[i + 2]);
return colours.size;"""


class PageTest(PageCase):
    ready = ()  # each test says what it waits for

    def expect_calm(self, browser):
        self.assertEqual(browser.errors(), [])

    def test_shows_the_map_within_two_seconds(self):
        browser = Browser()
        self.addCleanup(browser.quit)
        began = time.monotonic()
        browser.get(self.daemon.page())
        browser.wait(SHOWS_MAP, 5)
        self.assertLess(time.monotonic() - began, 2.0)
        browser.wait(IS_LIVE)
        self.assertGreater(browser.execute_script(DRAWN), 5)
        paint_ms = browser.execute_script('return performance.getEntriesByName("first-contentful-paint")[0].startTime')
        self.assertLess(paint_ms, 1000)
        self.expect_calm(browser)

    def test_fits_every_size_light_and_dark(self):
        for name, (width, height, mobile) in SIZES.items():
            for dark in (False, True):
                with self.subTest(size=name, dark=dark):
                    browser = self.open(width, height, mobile, dark)
                    browser.wait(SHOWS_MAP)
                    browser.wait('document.querySelectorAll("#status dd").length > 5 && window.deltamap.model.samples.length > 1')
                    browser.execute_script("return new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))")
                    self.assertEqual(browser.execute_script("return document.documentElement.dataset.theme"), "dark" if dark else "light")
                    self.assertLessEqual(browser.execute_script("return document.documentElement.scrollWidth"), width)
                    wide = browser.execute_script("""return [...document.querySelectorAll("body *")].filter((one) =>
                        one.getBoundingClientRect().right > innerWidth + 0.5 || one.getBoundingClientRect().left < -0.5).map((one) => one.tagName + "#" + one.id)""")
                    self.assertEqual(wide, [])
                    if not mobile:
                        self.assertLessEqual(browser.execute_script("return document.documentElement.scrollHeight"), height)
                    (browser.save_whole_page if mobile else browser.save_screenshot)(PICTURES / f"{name}-{'dark' if dark else 'light'}.png")
                    self.expect_calm(browser)

    def test_a_container_that_is_taken_away_in_the_hall_goes_away_on_the_page(self):
        browser = self.open(1440, 900)
        browser.wait(SHOWS_MAP)
        first = {}
        give_up_at = time.monotonic() + 300
        while time.monotonic() < give_up_at:
            for change in self.daemon.changes():
                if change["kind"] != "removed":
                    continue
                now = browser.execute_script(FREE_SHARE, change["box"][:4])
                before = first.setdefault(json.dumps(change), now)
                if now - before > 0.3:
                    browser.wait("document.querySelectorAll('#changes li:not(.refused) button').length > 0")
                    browser.save_screenshot(PICTURES / "changed.png")
                    return self.expect_calm(browser)
            time.sleep(0.3)
        self.fail("no container that was taken away has gone on the page in five minutes")

    def test_tells_whether_planners_may_drive_by_the_pose(self):
        browser = self.open()
        browser.wait("[...document.querySelectorAll('#status dt')].some((name) => name.textContent === 'Planners' && name.nextSibling.textContent === 'may drive by this pose')", 30)
        self.expect_calm(browser)

    def test_pausing_stops_revisions_while_containers_change(self):
        browser = self.open()
        browser.wait(SHOWS_MAP)
        newest = lambda: self.daemon.status()["newest_revision"]
        before = newest()
        self.until(lambda: newest() > before, 120)  # they come, as long as nobody pauses
        self.click(browser, "#pause")
        self.until(lambda: self.daemon.status()["mapping"] == "paused")
        time.sleep(1)  # what was on its way
        paused, changed, scans = newest(), len(self.daemon.changes()), self.daemon.status()["localized"]
        self.until(lambda: len(self.daemon.changes()) >= changed + 2, 35)
        self.assertEqual(newest(), paused)
        self.assertGreater(self.daemon.status()["localized"], scans + 50)
        self.click(browser, "#pause")
        self.until(lambda: newest() > paused, 120)
        self.expect_calm(browser)

    def test_a_daemon_that_freezes_is_told_within_seconds(self):
        browser = self.open()
        browser.wait(SHOWS_MAP)
        self.daemon.daemon.send_signal(signal.SIGSTOP)
        try:
            browser.wait('document.body.dataset.link === "lost" && document.querySelector("#badge-link").textContent === "no connection"', 7)
        finally:
            self.daemon.daemon.send_signal(signal.SIGCONT)
        browser.wait(IS_LIVE, 20)
        self.assertEqual([line for line in browser.errors() if "WebSocket" not in line], [])

    def test_a_robot_that_is_silent_is_shown_as_it_was(self):
        browser = self.open()
        browser.wait(SHOWS_MAP)
        self.daemon.simulator.send_signal(signal.SIGSTOP)
        try:
            browser.wait('window.deltamap.model.is_old && document.querySelector("#badge-state").textContent.startsWith("was ")', 6)
            self.assertEqual(browser.execute_script("return document.querySelector('#badge-state').dataset.level"), "none")
            browser.save_screenshot(PICTURES / "old.png")
        finally:
            self.daemon.simulator.send_signal(signal.SIGCONT)
        browser.wait("!window.deltamap.model.is_old", 20)
        self.expect_calm(browser)

    def test_the_connection_drops_and_comes_back(self):
        browser = self.open()
        browser.wait(SHOWS_MAP)
        self.daemon.stop()
        browser.wait('document.body.dataset.link === "lost" && !document.querySelector("#map-note").hidden')
        browser.save_screenshot(PICTURES / "lost.png")
        self.daemon.start()
        browser.wait(IS_LIVE, 20)
        browser.wait(SHOWS_MAP)
        self.assertTrue(browser.execute_script('return document.querySelector("#map-note").hidden'))
        refused = [line for line in browser.errors() if "ERR_CONNECTION_REFUSED" not in line]
        self.assertEqual(refused, [])

    def test_mouse_and_keyboard_move_the_map(self):
        browser = self.open()
        browser.wait(SHOWS_MAP)
        scale = "return window.deltamap.view.scale"
        centre = "return window.deltamap.view.centre.x"
        fitted = browser.execute_script(scale)
        browser.press("#map", "+")
        self.assertGreater(browser.execute_script(scale), fitted)
        before = browser.execute_script(centre)
        browser.press("#map", Keys.ARROW_RIGHT)
        self.assertGreater(browser.execute_script(centre), before)
        before = browser.execute_script(centre)
        browser.hand({0: (300, 300)}, {0: "down"}, {0: (400, 300)}, {0: "up"})
        self.assertLess(browser.execute_script(centre), before)
        browser.press("#map", "f")
        self.assertAlmostEqual(browser.execute_script(scale), fitted, 3)
        browser.press("#map", "r")
        self.assertEqual(browser.execute_script('return document.querySelector("#follow").getAttribute("aria-pressed")'), "true")
        self.expect_calm(browser)

    def test_fingers_move_and_pinch_the_map(self):
        browser = self.open(390, 844, True)
        browser.wait(SHOWS_MAP)
        x, y = browser.execute_script("const box = document.querySelector('#map').getBoundingClientRect(); return [Math.round(box.left + box.width / 2), Math.round(box.top + box.height / 2)]")
        now = lambda: browser.execute_script("const { view } = window.deltamap; return [view.centre.x, view.centre.y, view.scale]")
        before = now()
        browser.hand({0: (x, y)}, {0: "down"}, {0: (x + 60, y)}, {0: "up"}, kind="touch")
        moved = now()
        self.assertAlmostEqual(moved[0], before[0] - 60 / before[2], delta=0.1)
        self.assertEqual(moved[2], before[2])
        browser.hand({0: (x - 30, y), 1: (x + 30, y)}, {0: "down", 1: "down"}, {0: (x - 60, y), 1: (x + 60, y)}, {0: "up", 1: "up"}, kind="touch")
        self.assertAlmostEqual(now()[2] / moved[2], 2, delta=0.1)
        self.assertEqual(browser.execute_script("return window.deltamap.view.pointers.size"), 0)
        self.expect_calm(browser)

    def test_a_picked_change_is_ringed_and_layers_switch(self):
        browser = self.open()
        browser.wait(SHOWS_MAP)
        browser.wait("document.querySelectorAll('#changes li:not(.refused) button').length > 1", 90)
        browser.execute_script("[...document.querySelectorAll('#changes li:not(.refused) button')].at(-1).click()")
        self.assertIn(" m; ", browser.execute_script("return document.querySelector('#changes [aria-pressed=true] .why').textContent"), "its place")
        self.assertIsNotNone(browser.execute_script("return window.deltamap.model.picked"))
        pressed = "return [...document.querySelectorAll('#changes button')].filter((one) => one.getAttribute('aria-pressed') === 'true').length"
        self.assertEqual(browser.execute_script(pressed), 1)  # a newer change may lie above it by now
        browser.wait("document.querySelectorAll('#layers input').length === 9")
        browser.execute_script("document.querySelectorAll('#layers input').forEach((box) => box.click())")
        browser.execute_script("return new Promise((done) => requestAnimationFrame(done))")
        self.expect_calm(browser)

    def test_hover_shows_one_instant_in_all_charts(self):
        browser = self.open()
        browser.wait("window.deltamap?.model.samples.length > 3")
        place = browser.execute_script("""const box = document.querySelector("#charts canvas").getBoundingClientRect();
                                          return [Math.round(box.left + box.width * 0.8), Math.round(box.top + 20)]""")
        browser.hand({0: place})
        browser.wait('document.querySelector("#charts-instant").textContent.startsWith("at ")')
        # Every line tells its value of the same instant.
        told, there = browser.execute_script("""const { charts } = window.deltamap;
            const visible = charts.charts.filter((chart) => !chart.canvas.parentElement.hidden);
            const shown = (chart) => chart.values.map((value) => Number(value.textContent.split(" ").at(-1)));
            return [visible.map(shown), visible.map((chart) => chart.kind.lines.map(({ column }) => charts.instant[column]))]""")
        self.assertEqual(len(told), 6)  # those of the published method are for method: paper
        for chart, of_sample in zip(told, there):
            for value, wanted in zip(chart, of_sample):
                if wanted is not None and value is not None:
                    self.assertAlmostEqual(value, wanted, delta=max(0.006, 0.006 * abs(wanted)))
        self.assertIn("threshold", browser.execute_script('return document.querySelector("#charts canvas").getAttribute("aria-label")'))
        self.expect_calm(browser)

    def test_nothing_is_asked_of_anybody_else(self):
        browser = self.open()
        browser.wait(SHOWS_MAP)
        foreign = browser.execute_script("return performance.getEntriesByType('resource').map((one) => one.name).filter((name) => !name.startsWith(location.origin))")
        self.assertEqual([name for name in foreign if not name.startswith("data:")], [])


    def test_the_picture_of_the_readme(self):
        """build/browser/live.png; with DELTAMAP_WRITE_PICTURES=1 it is docs/images/live.png as well:
        DELTAMAP_WRITE_PICTURES=1 ./dev test browser page_test.PageTest.test_the_picture_of_the_readme"""
        browser = self.open(1440, 900)
        browser.wait(SHOWS_MAP)
        browser.wait("document.querySelectorAll('#changes li:not(.refused) button').length > 2 && window.deltamap.model.samples.length > 60", 180)
        browser.save_screenshot(PICTURES / "live.png")
        if os.environ.get("DELTAMAP_WRITE_PICTURES"):
            shutil.copyfile(PICTURES / "live.png", ROOT / "docs/images/live.png")
        self.expect_calm(browser)


if __name__ == "__main__":
    unittest.main(verbosity=2)
