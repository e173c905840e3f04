#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The live page and a report for those who see little or use the keyboard alone, at three sizes, light and dark: ./dev test browser."""

import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

from selenium.webdriver.common.keys import Keys

import accessible
from browser import Browser
from page_case import PICTURES, SHOWS_MAP, SIZES, PageCase
from running_daemon import BIN, ROOT

SPACE, ENTER, ESCAPE, RIGHT = " ", Keys.ENTER, Keys.ESCAPE, Keys.ARROW_RIGHT


class PageForAll(PageCase):
    robot = {"change_every_s": 10, "settings": {"dashboard.control": "true"}}
    ready = (SHOWS_MAP, 'document.querySelectorAll("#status dd").length > 5')

    def test_names_roles_and_contrast(self):
        for name, (width, height, mobile) in SIZES.items():
            for dark in (False, True):
                with self.subTest(size=name, dark=dark):
                    browser = self.open(width, height, mobile, dark)
                    browser.execute_script("document.querySelector('#layers-box').open = true")
                    self.assertEqual(accessible.findings(browser), [])
                    self.assertEqual(browser.execute_script(accessible.STICKS_OUT), [])
                    browser.save_screenshot(PICTURES / f"layers-{name}-{'dark' if dark else 'light'}.png")
                    self.assertEqual(browser.errors(), [])

    def test_the_check_finds_what_is_wrong(self):
        browser = self.open()
        browser.execute_script("""document.querySelector("#fit").textContent = ""; for (const name of ["aria-label", "title"]) document.querySelector("#fit").removeAttribute(name);
                                  document.querySelector("#status-title").style.color = "#dddddd"; document.querySelector("#status-title").style.background = "#ffffff";
                                  document.querySelector("#save").id = "pause"; document.querySelector("#zoom-in").style.cssText = "min-width:0;width:9px;padding:0";
                                  document.querySelector("#status-section").removeAttribute("tabindex"); document.querySelector("#status-section").style.height = "60px" """)
        found = "\n".join(accessible.findings(browser))
        for what in ("no name: button", "contrast 1.", "id twice: pause", "small to touch, 9", "scrollable-region-focusable: status-section"):
            self.assertIn(what, found)

    def test_the_keyboard_reaches_and_uses_everything(self):
        browser = self.open()
        browser.wait("document.querySelectorAll('#changes li:not(.refused) button').length > 0", 120)
        stops = accessible.walk(browser)
        self.assertGreaterEqual(len(stops) + 2, browser.execute_script(accessible.CAN_TAKE_FOCUS))  # a change may have come meanwhile
        self.assertEqual([stop for stop in stops if not stop["is_seen"]], [])
        self.assertIn("map", [stop["what"] for stop in stops])
        if not browser.execute_script("return document.querySelector('#layers-box').open"):
            browser.press("#layers-box summary", ENTER)
        browser.press("#layer-scan", SPACE)
        self.assertFalse(browser.execute_script("return document.querySelector('#layer-scan').checked"))
        browser.press("#changes li:not(.refused) button", ENTER)
        self.assertIsNotNone(browser.execute_script("return window.deltamap.model.picked"))
        before = browser.execute_script("return document.documentElement.dataset.theme")
        browser.press("#theme", ENTER)
        self.assertNotEqual(browser.execute_script("return document.documentElement.dataset.theme"), before)
        browser.press("#charts canvas", Keys.ARROW_LEFT)
        browser.wait('document.querySelector("#charts-instant").textContent.startsWith("at ")')
        browser.press("#pause", ENTER)
        browser.wait('window.deltamap.model.status.mapping === "paused"')
        browser.press("#pause", ENTER)
        browser.wait('window.deltamap.model.status.mapping === "on"')
        self.assertEqual(browser.errors(), [])

    def test_what_the_pose_rests_on_is_drawn_and_can_be_switched_off(self):
        browser = self.open(1440, 900)
        browser.wait("document.querySelectorAll('#layers input').length === 9")
        colours = """const { view } = window.deltamap, at = view.canvas.getContext("2d").getImageData(0, 0, view.canvas.width, view.canvas.height).data;
                     const ink = getComputedStyle(document.documentElement).getPropertyValue("--violet").trim(), [r, g, b] = [1, 3, 5].map((i) => parseInt(ink.slice(i, i + 2), 16));
                     let count = 0;
                     for (let i = 0; i < at.length; i += 4) if (Math.hypot(at[i] - r, at[i + 1] - g, at[i + 2] - b) < 12) ++count;
                     return count;"""
        # As the daemon sends them; when it does is up to the localizer.
        browser.execute_script("""const { model, view } = window.deltamap, { x_m, y_m } = model.pose;
                                  window.deltamap.connection.on.particles = () => {}; window.deltamap.connection.on.stored = () => {};
                                  model.particles = [];
                                  const ends = Array.from({ length: 80 }, (_, i) => (i % 2 ? y_m + 1 : x_m + i / 40));
                                  model.stored = [{ x: x_m, y: y_m, heading: 0, waits: false, ends }];
                                  view.scale = 60; view.show(x_m, y_m); view.draw();""")
        self.assertGreater(browser.execute_script(colours), 100)
        browser.press("#layer-stored", SPACE)
        browser.execute_script("window.deltamap.view.draw()")
        self.assertLess(browser.execute_script(colours), 100)
        browser.execute_script("""const { model, view } = window.deltamap, { x_m, y_m } = model.pose;
                                  model.particles = Array.from({ length: 600 }, (_, i) => (i % 3 === 2 ? 0.3 : (i % 3 ? y_m : x_m) + ((7 * i) % 11 - 5) / 10));
                                  view.draw();""")
        browser.save_screenshot(PICTURES / "particles.png")
        self.assertTrue(browser.execute_script("""const { view } = window.deltamap, drawn = () => { view.draw(); return view.canvas.toDataURL(); };
                                                  const box = document.querySelector("#layer-particles"), before = drawn();
                                                  box.click();
                                                  return drawn() !== before;"""))
        self.assertEqual([line for line in browser.errors() if "willReadFrequently" not in line], [])  # that is of this test's own reading

    def test_the_pilots_way_is_told_while_it_drives(self):
        browser = self.open()
        browser.wait("window.deltamap.model.pose?.pilot && window.deltamap.model.pose.pilot.speed_m_per_s !== undefined", 30)
        self.daemon.ctl("drive", "off")
        browser.wait("window.deltamap.model.pose && !window.deltamap.model.pose.pilot", 30)
        self.daemon.ctl("drive", "wander")


# The words "met" and "missed" that a reader finds only by scrolling a table sideways.
MET_OUT_OF_SIGHT = """return [...document.querySelectorAll(".met, .missed")].map((cell) => [cell.textContent, cell.getBoundingClientRect().right,
    cell.closest(".wide").getBoundingClientRect().right]).filter(([, right, edge]) => right > edge)"""


class ReportForAll(unittest.TestCase):
    """A report of an experiment, opened as a file."""

    @classmethod
    def setUpClass(cls):
        PICTURES.mkdir(parents=True, exist_ok=True)
        cls.folder = tempfile.TemporaryDirectory(prefix="deltamap-report-")
        subprocess.run([BIN / "deltamap-lab", "hall", "--out", cls.folder.name, "--minutes", "0.5", "--repeats", "5", "--jobs", "1",
                        "--scenarios", ROOT / "config/scenarios"], check=True, capture_output=True, cwd=ROOT)
        cls.url = (pathlib.Path(cls.folder.name) / "index.html").as_uri()

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def open(self, width=1280, height=800, mobile=False, dark=False):
        browser = Browser(width, height, dark, mobile)
        self.addCleanup(browser.quit)
        browser.get(self.url)
        return browser

    def test_fits_every_size_light_and_dark(self):
        for name, (width, height, mobile) in SIZES.items():
            for dark in (False, True):
                with self.subTest(size=name, dark=dark):
                    browser = self.open(width, height, mobile, dark)
                    self.assertEqual(browser.execute_script("return document.documentElement.dataset.theme"), "dark" if dark else "light")
                    self.assertLessEqual(browser.execute_script("return document.documentElement.scrollWidth"), width)
                    self.assertEqual(browser.execute_script(accessible.STICKS_OUT), [])
                    self.assertEqual(accessible.findings(browser), [])
                    self.assertEqual(browser.execute_script(MET_OUT_OF_SIGHT), [])
                    least = browser.execute_script("return Math.min(...[...document.querySelectorAll('svg text')].map((one) => one.getBoundingClientRect().height))")
                    self.assertGreater(least, 9)
                    browser.save_whole_page(PICTURES / f"report-{name}-{'dark' if dark else 'light'}.png")
                    self.assertEqual(browser.errors(), [])

    def test_pointer_and_keyboard_tell_the_values_of_all_lines(self):
        browser = self.open()
        told = "return [...document.querySelectorAll('figure.chart')][0].querySelector('.keys output').textContent"
        self.assertEqual(browser.execute_script(told), "")
        browser.execute_script("document.querySelector('figure.chart svg').scrollIntoView({ block: 'center' })")
        place = browser.execute_script("""const box = document.querySelector("figure.chart svg").getBoundingClientRect();
                                          return [Math.round(box.left + box.width / 2), Math.round(box.top + box.height / 2)]""")
        browser.hand({0: place})
        browser.wait("document.querySelector('figure.chart .keys output').textContent !== ''")
        browser.hand({0: [2, 2]})
        browser.wait("document.querySelector('figure.chart .keys output').textContent === ''")
        browser.press("figure.chart svg", RIGHT)
        first = browser.execute_script("return document.querySelector('figure.chart figcaption output').textContent")
        browser.press("figure.chart svg", RIGHT)
        self.assertNotEqual(browser.execute_script("return document.querySelector('figure.chart figcaption output').textContent"), first)
        # The value is the one that the line has there.
        value = browser.execute_script("""const figure = document.querySelector("figure.chart"), svg = figure.querySelector("svg");
            const [low, high] = svg.dataset.y.split(" ").map(Number), [, top, , bottom] = svg.dataset.plot.split(" ").map(Number);
            const at = Number(svg.querySelector(".instant").getAttribute("x1"));
            const point = [...svg.querySelector("polyline").points].reduce((best, one) => (Math.abs(one.x - at) < Math.abs(best.x - at) ? one : best));
            return [low + (bottom - point.y) / (bottom - top) * (high - low), Number(figure.querySelector(".keys output").textContent)]""")
        self.assertAlmostEqual(value[0], value[1], delta=0.006 * max(abs(value[0]), 1e-6))
        stops = accessible.walk(browser)
        self.assertEqual(len(stops), browser.execute_script(accessible.CAN_TAKE_FOCUS))
        self.assertEqual([stop for stop in stops if not stop["is_seen"]], [])
        browser.press("#theme", ENTER)
        self.assertEqual(browser.execute_script("return document.documentElement.dataset.theme"), "dark")

    def test_the_page_of_the_check_looks_alike(self):
        sys.path.insert(0, str(ROOT / "tests/support"))
        from report_page import report_page
        rows = [("intel <on> ref_intel", "median error, m", 0.0237, "≤ 0.06", True), ("all demos", "changes found", "2 of 13", "≥ 80 %", False)]
        file = pathlib.Path(self.folder.name) / "check.html"
        file.write_text(report_page("Figures promised", ["deltamap 0.1.0"], ["on", "figure", "measured", "at least", "met"], rows))
        for name, (width, height, mobile) in SIZES.items():
            browser = Browser(width, height, name == "phone", mobile)
            self.addCleanup(browser.quit)
            browser.get(file.as_uri())
            self.assertIn("intel <on> ref_intel", browser.execute_script("return document.querySelector('td').textContent"))
            self.assertEqual(browser.execute_script("return [...document.querySelectorAll('.missed')].length"), 1)
            self.assertEqual(browser.execute_script(MET_OUT_OF_SIGHT), [])
            self.assertLessEqual(browser.execute_script("return document.documentElement.scrollWidth"), width)
            self.assertEqual(accessible.findings(browser), [])
            self.assertEqual(browser.errors(), [])

    def test_tells_where_it_comes_from(self):
        browser = self.open()
        summary = json.loads((pathlib.Path(self.folder.name) / "summary.json").read_text())
        text = browser.execute_script("return document.body.textContent")
        for what in (summary["version"], summary["commit"], "settings as delivered"):
            self.assertIn(what, text)


if __name__ == "__main__":
    unittest.main(verbosity=2)
