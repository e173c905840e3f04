#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The live page as a newcomer meets it, at five sizes of window, and where devices are missing or silent, or mapping is off: ./dev test browser."""

import os
import pathlib
import pty
import signal
import subprocess
import tempfile
import time
import unittest
import urllib.request

import page_measures as measures
from browser import Browser
from page_case import PICTURES, SHOWS_MAP, PageCase
from running_daemon import BIN, ROOT, WORLD, free_port

FIVE_SIZES = {"phone": (390, 844, True), "netbook": (1024, 600, False), "laptop": (1366, 768, False), "wide": (1440, 900, False), "desk": (1920, 1080, False)}
HAS_STATUS = 'document.querySelectorAll("#status dd").length > 5'
HAS_GLOSSARY = 'document.querySelector("#status dt").title'
TWO_FRAMES = "return new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))"


class FirstLookTest(PageCase):
    robot = {"change_every_s": 5, "settings": {"dashboard.control": "true"}}
    ready = (SHOWS_MAP, HAS_STATUS, "window.deltamap.model.samples.length > 1")

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.daemon._until(lambda: cls.daemon.status()["newest_revision"] > 0, 240)
        cls.daemon.ctl("pause")  # the store has what the page shows

    def look_at_sizes(self, look):
        for name, (width, height, mobile) in FIVE_SIZES.items():
            with self.subTest(size=name):
                look(self.open(width, height, mobile), name)

    def open_all(self, browser):
        """History with the question whether to undo, the layers, and the pad."""
        browser.execute_script("document.querySelector('#layers-box').open = true; document.querySelector('#history').click()")
        browser.wait("!document.querySelector('#history-bar').hidden && window.deltamap.history.maps && !document.querySelector('#history-undo').disabled")
        browser.execute_script("document.querySelector('#history-undo').click()")
        browser.execute_script(TWO_FRAMES)

    def test_the_map_has_half_of_the_window_and_nothing_covers_a_button(self):
        def look(browser, name):
            self.assertGreaterEqual(browser.execute_script(measures.MAP_SHARE), 0.5, "as it opens")
            self.assertEqual(browser.execute_script(measures.COVERED), [], "as it opens")
            self.assertEqual(browser.execute_script(measures.FITS), [], "as it opens")
            self.click(browser, "#history")
            browser.wait("!document.querySelector('#history-bar').hidden && window.deltamap.history.maps")
            browser.execute_script(TWO_FRAMES)
            browser.save_screenshot(PICTURES / f"first-history-{name}.png")
            self.assertGreaterEqual(browser.execute_script(measures.MAP_SHARE), 0.5, "with History open")
            self.click(browser, "#history")
            self.open_all(browser)
            browser.save_screenshot(PICTURES / f"first-all-{name}.png")
            self.assertEqual(browser.execute_script(measures.COVERED), [], "with everything open")
            self.assertEqual(browser.execute_script(measures.FITS), [], "with everything open")
            browser.execute_script("document.querySelector('#pad').hidden = false")
            self.assertEqual(browser.execute_script(measures.COVERED), [], "with the pad")

        self.look_at_sizes(look)

    def test_every_word_has_its_line_of_the_glossary(self):
        def look(browser, _):
            browser.wait(HAS_GLOSSARY)
            self.open_all(browser)
            self.assertGreater(len(browser.execute_script(measures.WORDS)), 50)
            self.assertEqual(measures.words_without_line(browser), [])

        self.look_at_sizes(look)

    def test_undecided_is_told_calmly_and_explained(self):
        browser = self.open()
        browser.wait(HAS_GLOSSARY)
        level, colour, amber, title = browser.execute_script("""return import("/page/panels.js").then(({ show_pose }) => {
            show_pose({ ...window.deltamap.model.pose, verdict: "undecided" }, false);
            const badge = document.querySelector("#badge-verdict"), level = badge.dataset.level, colour = getComputedStyle(badge).color, title = badge.title;
            badge.style.transition = "none";
            badge.dataset.level = "warn";
            return [level, colour, getComputedStyle(badge).color, title];
        })""")
        self.assertNotIn(level, ("warn", "bad"))
        self.assertNotEqual(colour, amber)
        self.assertIn("not yet enough", title)

    def test_changes_are_counted_since_the_start(self):
        browser = self.open()
        browser.execute_script("""window.deltamap.connection.on.changes({ type: "changes", first: 700, accepted: 800, refused: 40, changes: [] })""")
        self.assertEqual(browser.execute_script("return document.querySelector('#changes-count').textContent"), "800 accepted, 40 refused")

    def test_silent_devices_leave_what_was(self):
        browser = self.open()
        self.daemon.simulator.send_signal(signal.SIGSTOP)
        try:
            browser.wait('window.deltamap.model.is_old && window.deltamap.model.status.ports.robot === "down"', 60)
            browser.wait('document.querySelector("#status").textContent.includes("robot down")')
            browser.save_screenshot(PICTURES / "first-silent.png")
            self.assertEqual(measures.shown_though_unknown(browser, place=True), [])
            self.assertRegex(browser.execute_script("return document.querySelector('#problems').textContent"), "robot does not answer: .+")
        finally:
            self.daemon.simulator.send_signal(signal.SIGCONT)
        browser.wait("!window.deltamap.model.is_old", 60)


class LoneDaemon:
    """A daemon with a page and ports that a test has made."""

    def __init__(self, **settings):
        self.folder = tempfile.TemporaryDirectory(prefix="deltamap-lone-")
        place = pathlib.Path(self.folder.name)
        self.url = f"http://127.0.0.1:{(port := free_port())}/"
        subprocess.run([BIN / "deltamap", "sim", "--world", WORLD, "--write-map", place / "m0.yaml"], check=True, capture_output=True)
        own = {"dashboard.port": port, "map.file": place / "m0.yaml", "map.store": place / "store.sqlite", "control.socket": place / "ctl.sock",
               "robot.port": place / "robot", "laser.port": place / "laser", **settings}
        words = [word for key, value in own.items() for word in ("--set", f"{key}={value}")]
        self.log = (place / "log").open("w")
        self.daemon = subprocess.Popen([BIN / "deltamapd", "--config", ROOT / "config/simulation.yaml", *words], stderr=self.log, stdout=self.log, cwd=ROOT)

    def __enter__(self):
        give_up_at = time.monotonic() + 60
        while time.monotonic() < give_up_at:
            try:
                urllib.request.urlopen(self.url, timeout=5).read()
                return self
            except OSError:
                time.sleep(0.1)
        raise RuntimeError((pathlib.Path(self.folder.name) / "log").read_text()[-2000:])

    def __exit__(self, *_):
        self.daemon.terminate()
        self.daemon.wait(60)
        self.log.close()
        self.folder.cleanup()


class WithoutDevicesTest(unittest.TestCase):
    def open(self, daemon):
        PICTURES.mkdir(parents=True, exist_ok=True)
        browser = Browser(1366, 768)
        self.addCleanup(browser.quit)
        browser.get(daemon.url)
        browser.wait(HAS_STATUS, 30)
        return browser

    def test_nothing_is_shown_that_nobody_knows(self):
        with LoneDaemon() as daemon:
            browser = self.open(daemon)
            browser.save_screenshot(PICTURES / "first-no-devices.png")
            self.assertEqual(measures.shown_though_unknown(browser), [])
            browser.wait("/laser does not answer: .*No such file/.test(document.querySelector('#problems').textContent)", 20)

    def test_why_a_port_is_down_stands_on_the_page(self):
        with tempfile.TemporaryDirectory() as place:
            regular = pathlib.Path(place, "robot")
            regular.write_text("")
            master, slave = pty.openpty()
            self.addCleanup(os.close, master)
            self.addCleanup(os.close, slave)
            with LoneDaemon(**{"robot.port": regular, "laser.port": os.ttyname(slave)}) as daemon:
                browser = self.open(daemon)
                browser.wait("/robot does not answer: .+/.test(document.querySelector('#problems').textContent)", 20)
                browser.wait("/laser down: .+/.test(document.querySelector('#status').textContent)", 60)

    def test_no_gate_is_open_where_mapping_is_off(self):
        with LoneDaemon(**{"mapping.enabled": "false"}) as daemon:
            browser = self.open(daemon)
            self.assertEqual(measures.shown_though_unknown(browser, mapping=False), [])
            browser.wait("document.querySelector('#badge-gate').textContent === 'mapping off'")


class MappingOffTest(PageCase):
    robot = {"settings": {"mapping.enabled": "false"}}
    ready = (SHOWS_MAP, HAS_STATUS)

    def test_no_gate_is_open_though_scans_come(self):
        browser = self.open()
        self.assertEqual(measures.shown_though_unknown(browser, scans=True, robot=True, mapping=False), [])


class PaperTest(PageCase):
    robot = {"settings": {"mapping.method": "paper"}}
    ready = (SHOWS_MAP, HAS_STATUS, "window.deltamap.model.samples.length > 1")

    def test_the_published_methods_charts_are_shown(self):
        browser = self.open()
        browser.execute_script(TWO_FRAMES)
        titles = browser.execute_script("return [...document.querySelectorAll('figcaption b')].filter((one) => one.checkVisibility()).map((one) => one.textContent)")
        for title in ("Weight", "Divergence ratio", "Effective samples"):
            self.assertIn(title, titles)
        browser.wait(HAS_GLOSSARY)
        self.assertEqual(measures.words_without_line(browser), [])


if __name__ == "__main__":
    unittest.main(verbosity=2)
