#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The history of the map on the live page, in Chromium, with a simulated robot behind it: ./dev test browser."""

import json
import unittest

from selenium.webdriver.common.keys import Keys

from page_case import PICTURES, SHOWS_MAP, PageCase

TEXT = 'document.querySelector("#history-text").textContent'
IS_SHOWN = f'!document.querySelector("#history-bar").hidden && window.deltamap.model.delta && !{TEXT}.endsWith("…")'
# Cells that the shown tiles have, by state.
COUNTS = """const { view } = window.deltamap, counts = [0, 0, 0];
for (const tile of (view.past ?? view.tiles).values()) for (const state of tile.states) ++counts[state];
return counts;"""
# How the cells of the shown delta stand in the shown tiles: as before it, and as after it.
OF_DELTA = """const { view, model } = window.deltamap, side = 256;
const state = (column, row) => {
  const tile = view.past.get(`${Math.floor(column / side)},${Math.floor(row / side)}`);
  return tile ? tile.states[(row - tile.row) * side + column - tile.column] : 2;
};
return [2, 3].map((at) => model.delta.filter((cell) => state(cell[0], cell[1]) === cell[at]).length).concat(model.delta.length);"""
OF_LIVE = OF_DELTA.replace("view.past.get", "view.tiles.get")  # in the newest map


class HistoryTest(PageCase):
    """One robot for all, which has changed its map."""

    ready = (SHOWS_MAP, "window.deltamap.model.status && document.querySelectorAll('#changes li:not(.refused) button').length > 2")

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.daemon._until(lambda: cls.daemon.status()["newest_revision"] >= 3, 240)
        cls.daemon.ctl("pause")

    def pick(self, browser, revision):
        browser.execute_script("""const name = `M${arguments[0]}`;
            [...document.querySelectorAll("#changes button")].find((one) => one.querySelector("b").textContent === name).click()""", revision)
        browser.wait(f"{IS_SHOWN} && {TEXT}.startsWith('M{revision} of ')")

    def slide_to(self, browser, revision):
        browser.execute_script("""const slider = document.querySelector("#history-slider");
            slider.value = arguments[0];
            slider.dispatchEvent(new Event("input"))""", revision)
        browser.wait(f"{IS_SHOWN} && {TEXT}.startsWith('M{revision} of ')")

    def test_a_picked_change_is_shown_before_and_after(self):
        for dark in (False, True):
            browser = self.open(1440, 900, dark=dark)
            self.pick(browser, 2)
            before, after, cells = browser.execute_script(OF_DELTA)
            self.assertEqual((before, after), (0, cells))
            self.assertGreater(cells, 0)
            browser.save_screenshot(PICTURES / f"history-{'dark' if dark else 'light'}.png")
            browser.execute_script("document.querySelector('#history-before').click()")
            self.assertEqual(browser.execute_script(OF_DELTA), [cells, 0, cells])
            browser.save_screenshot(PICTURES / f"history-before-{'dark' if dark else 'light'}.png")
            self.assertEqual(browser.errors(), [])

    def test_the_slider_walks_from_the_first_map_to_the_newest(self):
        browser = self.open()
        live = browser.execute_script(COUNTS)
        newest = self.daemon.status()["newest_revision"]
        browser.execute_script("document.querySelector('#history').click()")
        browser.wait(IS_SHOWN)
        self.assertEqual(browser.execute_script("return Number(document.querySelector('#history-slider').max)"), newest)
        shown = browser.execute_script(COUNTS)
        self.assertEqual(shown[:2], live[:2])
        self.slide_to(browser, 0)
        self.assertNotEqual(browser.execute_script(COUNTS)[:2], live[:2])
        self.assertTrue(browser.execute_script("return document.querySelector('#history-undo').disabled"))
        browser.press("#history-slider", Keys.ARROW_RIGHT)
        browser.wait(f"{TEXT}.startsWith('M1 of ')")
        browser.press("#history-slider", Keys.ESCAPE)
        self.assertEqual(browser.execute_script("return window.deltamap.view.past"), None)
        self.assertEqual(browser.execute_script(COUNTS), live)
        self.assertEqual(browser.errors(), [])

    def test_undo_asks_first_and_brings_the_cells_back(self):
        newest = self.daemon.status()["newest_revision"]
        browser = self.open()
        self.pick(browser, newest)
        cells, (before, after, _) = browser.execute_script("return window.deltamap.model.delta"), browser.execute_script(OF_LIVE)
        self.assertEqual((before, after), (0, len(cells)), "mapping is paused: the newest map is as that change left it")
        browser.execute_script("""window.sent = [];
            const real = window.fetch;
            window.fetch = (address, options) => { if (address === "/api/command") window.sent.push(options.body); return real(address, options); };""")
        self.click(browser, "#history-undo")
        browser.wait("!document.querySelector('#task').hidden")
        self.assertEqual(browser.execute_script("return window.sent"), [])
        self.choose(browser, f"Undo M{newest}")
        browser.wait("document.querySelector('#task').dataset.level === 'good'")
        self.assertEqual([json.loads(body) for body in browser.execute_script("return window.sent")], [{"command": "undo", "revision": newest}])
        browser.wait(f"{TEXT}.startsWith('M{newest} of M{newest + 1}: ')", 5)
        self.assertEqual(browser.execute_script(OF_LIVE), [len(cells), 0, len(cells)])
        browser.wait(f"document.querySelector('#changes button b').textContent === 'M{newest + 1}'")
        self.assertIn("by an operator", browser.execute_script("return document.querySelector('#changes .why').textContent"))
        self.assertEqual(browser.errors(), [])

    def test_refused_changes_are_folded_away(self):
        browser = self.open()
        refused = dict(time=1, phase=4, scans=9, accepted=False, revision=None, added=0, freed=0, forgotten=0, box_m=[0, 0, 0, 0], acceptance=0.2, reason="of this test")
        browser.execute_script("window.deltamap.connection.on.changes({ changes: [arguments[0]] })", refused)
        times = browser.execute_script("return [...document.querySelectorAll('#changes li[data-time]')].map((one) => Number(one.dataset.time))")
        self.assertEqual(times, sorted(times, reverse=True))
        seen = "[...document.querySelectorAll('#changes li')].filter((one) => one.checkVisibility() && one.textContent.includes('of this test')).length"
        self.assertEqual(browser.execute_script(f"return {seen}"), 0)
        self.assertNotIn(" 0 refused", browser.execute_script("return document.querySelector('#changes-count').textContent"))
        self.click(browser, "#changes-refused")
        self.assertEqual(browser.execute_script(f"return {seen}"), 1)
        browser.execute_script("[...document.querySelectorAll('#changes button')].find((one) => one.textContent.includes('of this test')).click()")
        browser.wait("document.querySelector('.task-text').textContent.includes('nothing to show')")
        self.assertEqual(browser.errors(), [])

    def test_fits_a_phone_and_a_netbook(self):
        for width, height, mobile in ((390, 844, True), (1024, 600, False)):
            with self.subTest(width=width):
                browser = self.open(width, height, mobile)
                self.pick(browser, 2)
                self.assertLessEqual(browser.execute_script("return document.documentElement.scrollWidth"), width)
                wide = browser.execute_script("""const map = document.querySelector("#map-section").getBoundingClientRect();
                    return [...document.querySelectorAll("#map-foot *")].filter((one) => one.getBoundingClientRect().right > map.right
                      || one.getBoundingClientRect().bottom > map.bottom).map((one) => one.id)""")
                self.assertEqual(wide, [])
                middle = "(([left, bottom, right, top]) => [(left + right) / 2, (bottom + top) / 2])(model.picked.box_m)"
                self.expect_in_sight(browser, middle)
                self.click(browser, "#history-undo")
                browser.wait("!document.querySelector('#task').hidden")
                self.expect_in_sight(browser, middle)
                browser.save_screenshot(PICTURES / f"undo-{width}.png")
                self.choose(browser, "Cancel")
                browser.save_screenshot(PICTURES / f"history-{width}.png")

    def test_machines_read_maps_and_scan(self):
        self.assertTrue(self.daemon.get("/api/map.pgm").startswith(b"P5\n"))
        self.assertIn(b"image: map.pgm", self.daemon.get("/api/map.yaml"))
        self.assertGreater(len(json.loads(self.daemon.get("/api/scan"))["ends_m"]), 50)


if __name__ == "__main__":
    unittest.main(verbosity=2)
