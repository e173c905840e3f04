#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Bays and zones are drawn on the live page in Chromium, with the daemon of a simulated robot behind it: ./dev test browser."""

import json
import unittest

from selenium.webdriver import ActionChains
from selenium.webdriver.common.keys import Keys

from browser import Browser
from page_case import PICTURES, SHOWS_MAP, SIZES, PageCase

TASK = 'document.querySelector("#task .task-text").textContent'
CORNERS = "return window.deltamap.model.drawing.corners"
CAN_DRAW = '!document.querySelector("#draw").hidden && !document.querySelector("#draw").disabled'


class DrawingTest(PageCase):
    robot = {"change_every_s": 300, "files": {"zones.yaml": "# by hand\nzones:\n", "bays.yaml": "bays:\n"},
             "places": {"zones.file": "zones.yaml", "bays.file": "bays.yaml"}}
    ready = (SHOWS_MAP, CAN_DRAW)

    def tearDown(self):
        """Each test finds a site where nothing is drawn."""
        for name, first in self.robot["files"].items():
            (self.daemon.place / name).write_text(first)
        self.assertEqual(self.daemon.ctl("reload").returncode, 0)

    def site(self):
        return json.loads(self.daemon.get("/api/site"))

    def begin(self, browser, place):
        """Looks at a piece of floor from nearby."""
        self.click(browser, "#draw")
        browser.wait('!document.querySelector("#drawing").hidden')
        self.choose_place(browser, place)
        browser.execute_script("const { view } = window.deltamap; view.scale = 40; view.show(6, 5)")

    def choose_place(self, browser, place):
        browser.execute_script("const select = document.querySelector('#drawing-place'); select.value = arguments[0]; select.dispatchEvent(new Event('change'))", place)

    def fill(self, browser, **fields):
        for name, value in fields.items():
            browser.execute_script("const field = document.querySelector(arguments[0]); field.value = arguments[1]; field.dispatchEvent(new Event('change'))",
                                   f"#drawing-{name}", value)

    def at(self, browser, x, y):
        """The pixel of a point of the map."""
        return browser.execute_script("""const { view } = window.deltamap, box = view.canvas.getBoundingClientRect(), [px, py] = view.to_screen(arguments[0], arguments[1]);
                                         return [Math.round(box.left + px), Math.round(box.top + py)]""", x, y)

    def click_at(self, browser, *points):
        for x, y in points:
            browser.hand({0: tuple(self.at(browser, x, y))}, {0: "down"}, {0: "up"})

    def expect_near(self, corners, wanted):
        self.assertEqual(len(corners), len(wanted), corners)
        for corner, want in zip(corners, wanted):
            self.assertLess(max(abs(a - b) for a, b in zip(corner, want)), 0.06, corners)

    def test_a_zone_is_drawn_changed_and_taken_away(self):
        browser = self.open()
        self.begin(browser, "zone:")
        square = [(5, 4), (7, 4), (7, 6), (5, 6)]
        self.click_at(browser, *square, square[0])
        self.assertTrue(browser.execute_script("return window.deltamap.model.drawing.is_closed"))
        self.fill(browser, id="gate", type="SPEED_LIMIT", speed="0.3", name="the gate")
        browser.save_screenshot(PICTURES / "drawing.png")
        self.click(browser, "#drawing-save")
        browser.wait(f"{TASK}.startsWith('in force, and written: 1 zone in ')")
        self.assertIn("that loses (comments, layout) is kept in", browser.execute_script(f"return {TASK}"))
        zone = self.site()["zones"]["places"][0]
        self.assertEqual((zone["zoneId"], zone["zoneType"], zone["maximumSpeed"], zone["zoneDescriptor"]), ("gate", "SPEED_LIMIT", "0.3", "the gate"))
        self.expect_near(zone["vertices"], square)
        browser.wait("window.deltamap.model.zones.length === 1 && document.querySelector('#drawing-place').value === 'zone:gate'")
        browser.hand({0: tuple(self.at(browser, 7, 6))}, {0: "down"}, {0: tuple(self.at(browser, 8, 7))}, {0: "up"})
        self.click_at(browser, (6, 4))  # a side's middle becomes a corner
        self.click(browser, "#drawing-save")
        self.until(lambda: len(self.site()["zones"]["places"][0]["vertices"]) == 5)
        self.expect_near(self.site()["zones"]["places"][0]["vertices"], [(5, 4), (6, 4), (7, 4), (8, 7), (5, 6)])
        browser.wait("!document.querySelector('#drawing-remove').disabled")
        self.click(browser, "#drawing-remove")
        self.choose(browser, "Take away")
        self.until(lambda: self.site()["zones"]["places"] == [])
        browser.wait("window.deltamap.model.zones.length === 0")
        self.assertEqual(browser.errors(), [])

    def test_a_bay_is_drawn_by_keys_and_numbers_alone(self):
        browser = self.open()
        self.begin(browser, "bay:")
        self.fill(browser, id="B4", station="ST-17", corners="5 4; 7 4; 7 6; 5 6; 4 5")
        browser.execute_script("window.deltamap.model.drawing.held = 4; document.querySelector('#map').focus()")
        ActionChains(browser).send_keys(Keys.ARROW_LEFT).perform()
        self.assertEqual(browser.execute_script(CORNERS)[4], [3.95, 5])
        ActionChains(browser).send_keys(Keys.DELETE).perform()
        self.assertEqual(browser.execute_script(CORNERS), [[5, 4], [7, 4], [7, 6], [5, 6]])
        browser.press("#drawing-save", Keys.ENTER)
        browser.wait("window.deltamap.model.bays.length === 1")
        self.assertEqual(self.site()["bays"]["places"], [{"id": "B4", "stationId": "ST-17", "polygon": [[5, 4], [7, 4], [7, 6], [5, 6]]}])
        self.fill(browser, corners="5 4; 7 four")
        browser.wait(f"{TASK}.startsWith('Corners are written as')")
        browser.press("#drawing-corners", Keys.ESCAPE)
        self.assertTrue(browser.execute_script("return document.querySelector('#drawing').hidden && window.deltamap.model.drawing === null"))
        self.assertEqual(browser.errors(), [])

    def test_a_zone_bears_its_id_on_the_map(self):
        (self.daemon.place / "zones.yaml").write_text("zones:\n  - {zoneId: gate, zoneType: BLOCKED, vertices: [[5, 4], [7, 4], [7, 6], [5, 6]]}\n")
        self.assertEqual(self.daemon.ctl("reload").returncode, 0)
        browser = self.open()
        browser.wait("window.deltamap.model.zones.length === 1")
        written = browser.execute_async_script("""const [scales, done] = arguments, { model } = window.deltamap;
            import("/page/zones.js").then(({ draw_zones }) => done(scales.map((scale) => {
              const names = [], context = document.createElement("canvas").getContext("2d");
              context.fillText = (...what) => names.push(what);
              draw_zones(context, { scale, to_screen: (x, y) => [scale * x, -scale * y] }, model);
              return names;
            })))""", [20, 5])
        self.assertEqual(written, [[["gate", 5 * 20 + 5, -6 * 20 + 14]], []])  # nearby alone, right of its upper left corner

    def test_what_the_daemon_refuses_is_told_and_stays_drawn(self):
        browser = self.open()
        self.begin(browser, "zone:")
        self.fill(browser, id="knot", corners="5 4; 7 6; 7 4; 5 6")
        self.click(browser, "#drawing-save")
        browser.wait(f"{TASK}.includes(\"zone 'knot' crosses itself\")")
        self.assertEqual(len(browser.execute_script(CORNERS)), 4)
        self.assertEqual(self.site()["zones"]["places"], [])
        self.assertTrue(all("409" in line for line in browser.errors()))

    def test_of_two_who_draw_the_second_looks_again(self):
        first, second = self.open(), self.open()
        for browser, name in ((first, "one"), (second, "two")):
            self.begin(browser, "zone:")
            self.fill(browser, id=name, corners="5 4; 7 4; 7 6")
        self.click(first, "#drawing-save")
        first.wait(f"{TASK}.startsWith('in force')")
        self.click(second, "#drawing-save")
        second.wait(f"{TASK}.includes('look at them again')")
        self.assertEqual([zone["zoneId"] for zone in self.site()["zones"]["places"]], ["one"])
        second.wait("document.querySelector('#drawing-place').textContent.includes('zone one')")
        self.click(second, "#drawing-save")
        second.wait(f"{TASK}.startsWith('in force')")
        self.assertEqual([zone["zoneId"] for zone in self.site()["zones"]["places"]], ["one", "two"])

    def test_nobody_draws_without_the_token(self):
        browser = Browser()
        self.addCleanup(browser.quit)
        browser.get(self.daemon.url)
        browser.wait(SHOWS_MAP)
        browser.wait("!document.querySelector('#unlock').hidden")
        self.assertTrue(browser.execute_script("return document.querySelector('#draw').hidden"))

    def test_there_is_room_for_it_at_every_size(self):
        for name, (width, height, mobile) in SIZES.items():
            with self.subTest(size=name):
                browser = self.open(width, height, mobile)
                self.begin(browser, "zone:")
                self.fill(browser, corners="5 4; 7 4; 7 6; 5 6")
                self.expect_in_sight(browser, "[6, 5]")
                browser.save_screenshot(PICTURES / f"drawing-{name}.png")


class NoFileTest(PageCase):
    robot = {"change_every_s": 300}
    ready = (SHOWS_MAP, CAN_DRAW)

    def test_the_key_that_names_the_file_is_told(self):
        browser = self.open()
        self.click(browser, "#draw")
        browser.wait(f"{TASK}.startsWith(\"'bays.file' names no file\")")
        self.assertTrue(browser.execute_script("return document.querySelector('#drawing-save').disabled"))
        self.assertEqual(browser.errors(), [])


if __name__ == "__main__":
    unittest.main(verbosity=2)
