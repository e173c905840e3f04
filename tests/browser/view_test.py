#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""`deltamap view` in Chromium: a run's folder, a recording and a map, scrubbed: ./dev test browser."""

import json
import pathlib
import signal
import subprocess
import tempfile
import time
import unittest

from selenium.webdriver.common.keys import Keys

from browser import Browser
from running_daemon import BIN, ROOT, RunningDaemon

PICTURES = ROOT / "build/browser"
DRIVE_S = 60
HAS_MAP = "window.deltamap?.view.tiles.size > 0"
IS_READ = "window.deltamap?.run.told?.complete && window.deltamap.model.pose"
SETTLED = "!window.deltamap.run.is_busy && window.deltamap.model.until === window.deltamap.run.wanted"
# To a share of the run, as a hand on the slider.
SCRUB = """
const slider = document.querySelector("#run-slider");
slider.value = arguments[0] * slider.max;
slider.dispatchEvent(new Event("input"));"""


class View:
    """`deltamap view` until the `with` block ends."""

    def __init__(self, *words):
        self.process = subprocess.Popen([BIN / "deltamap", "view", *words], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, cwd=ROOT)
        self.url = self.process.stdout.readline().strip()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.process.send_signal(signal.SIGINT)
        self.said = self.process.communicate(timeout=60)[1]


def cut_in_a_block(recording, share):
    """The first part of a pcapng file, up to the middle of a block."""
    at = 0
    while at + (size := int.from_bytes(recording[at + 4:at + 8], "little")) < share * len(recording):
        at += size
    return recording[:at + size // 2]


class ViewTest(unittest.TestCase):
    """One recorded drive for all."""

    @classmethod
    def setUpClass(cls):
        PICTURES.mkdir(parents=True, exist_ok=True)
        cls.folder = tempfile.TemporaryDirectory(prefix="deltamap-view-")
        cls.place = pathlib.Path(cls.folder.name)
        cls.how = ["--map", cls.place / "m0.yaml", "--config", ROOT / "config/simulation.yaml", "--set", "mapping.persistence_s=3"]
        with RunningDaemon(port=0, change_every_s=5, settings={"recording.file": cls.place / "drive.pcapng", "mapping.persistence_s": 3}) as daemon:
            give_up_at = time.monotonic() + 240
            while daemon.status()["localized"] < 10 * DRIVE_S or daemon.status()["newest_revision"] < 2:
                assert time.monotonic() < give_up_at, daemon.status()
                time.sleep(0.2)
            for name in ("m0.yaml", "m0.pgm"):
                (cls.place / name).write_bytes((daemon.place / name).read_bytes())
        subprocess.run([BIN / "deltamap", "replay", cls.place / "drive.pcapng", *cls.how, "--out", cls.place / "run"], check=True, capture_output=True, cwd=ROOT)

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def open(self, url, width=1280, height=800, mobile=False, dark=False):
        browser = Browser(width, height, dark, mobile)
        self.addCleanup(browser.quit)
        browser.get(url)
        return browser

    def scrub(self, browser, share):
        browser.execute_script(SCRUB, share)
        browser.wait(SETTLED)
        return browser.execute_script("const { pose, scan, until } = window.deltamap.model; return { pose, beams: scan?.beams.length ?? 0, until, shown: window.deltamap.view.past !== null }")

    def test_a_folder_is_scrubbed_from_end_to_end(self):
        with View(self.place / "run") as view:
            browser = self.open(view.url)
            browser.wait(f"{HAS_MAP} && {IS_READ}")
            first, last = self.scrub(browser, 0), self.scrub(browser, 1)
            lines = (self.place / "run/localization.csv").read_text().splitlines()
            rows = [dict(zip(lines[0].split(","), line.split(","))) for line in lines[1:]]
            for moment, row in ((first, rows[0]), (last, rows[-1])):
                self.assertAlmostEqual(moment["pose"]["time"], float(row["time"]), 3)
                self.assertAlmostEqual(moment["pose"]["x_m"], float(row["x_m"]), 6)
            self.assertEqual(first["beams"], 0)
            self.assertTrue(first["shown"], "the first pose was computed on an older map")
            written = [json.loads(line) for line in (self.place / "run/changes.jsonl").read_text().splitlines()]
            newest = max(change.get("revision") or 0 for change in written)  # at times after the last pose
            self.assertEqual(last["shown"], int(rows[-1]["revision"]) < newest)
            self.assertEqual(browser.execute_script("return document.querySelector('#controls').hidden"), True)
            self.assertGreater(browser.execute_script("return document.querySelectorAll('#changes button').length"), 1)
            self.scrub(browser, 0.5)
            browser.save_screenshot(PICTURES / "view-folder.png")
            self.assertEqual(browser.errors(), [])
        self.assertEqual(view.process.returncode, 0)
        self.assertEqual(view.said, "")

    def test_a_recording_shows_its_scans_while_and_after_it_is_read(self):
        with View(self.place / "drive.pcapng", *self.how) as view:
            browser = self.open(view.url, 1440, 900, dark=True)
            browser.wait(HAS_MAP)
            browser.wait(IS_READ, 60)
            middle = self.scrub(browser, 0.5)
            self.assertGreater(middle["beams"], 100)
            on_obstacles = browser.execute_script("""const { view, model: { scan } } = window.deltamap; let hits = 0;
                for (let i = 0; i < scan.ends.length; i += 2) if (view.state_near(scan.ends[i], scan.ends[i + 1], 0.15) === 1) ++hits;
                return hits / (scan.ends.length / 2)""")
            self.assertGreater(on_obstacles, 0.6, "the scan lies on the map of its time")
            browser.save_screenshot(PICTURES / "view-recording.png")
            kept = []
            for share in range(0, 21):
                self.scrub(browser, share / 20)
                kept.append(browser.execute_script("const { particles, stored, transient } = window.deltamap.model; return [particles.length, stored.length, transient !== null]"))
            self.assertGreater(kept[0][0], 10, "the first pose rests on particles")
            self.assertGreater(max(scans for _, scans, _ in kept), 0, "scans of a Δ-phase")
            self.assertTrue(all(transient for *_, transient in kept))
            self.scrub(browser, 0.5)
            browser.execute_script("document.querySelector('#changes li:not(.refused) button').click()")
            browser.wait("window.deltamap.model.delta")
            browser.save_screenshot(PICTURES / "view-change.png")
            browser.execute_script("document.querySelector('#history-close').click()")
            self.scrub(browser, 0.5)  # the change may lie at the very end
            before = browser.execute_script("return window.deltamap.run.wanted")
            browser.execute_script("document.querySelector('#run-play').click()")
            browser.wait(f"window.deltamap.run.wanted > {before} + 2")
            browser.execute_script("document.querySelector('#run-play').click()")
            browser.press("#run-slider", Keys.ARROW_LEFT)
            browser.wait(SETTLED)
            self.assertEqual(browser.errors(), [])
        self.assertEqual(view.process.returncode, 0)

    def test_one_slider_walks_through_time_and_revisions(self):
        with View(self.place / "run") as view:
            browser = self.open(view.url, 1440, 900)
            browser.wait(f"{HAS_MAP} && {IS_READ}")
            browser.execute_script("document.querySelector('#history').click()")
            browser.wait("window.deltamap.history.is_open && window.deltamap.history.maps")
            self.assertEqual(browser.execute_script("return [...document.querySelectorAll('input[type=range]')].filter((one) => one.checkVisibility()).map((one) => one.id)"), ["run-slider"])
            self.scrub(browser, 0)
            browser.wait("window.deltamap.history.number === 0 && window.deltamap.history.maps")
            self.scrub(browser, 1)
            browser.wait("window.deltamap.history.number > 0 && window.deltamap.history.maps")
            self.assertEqual(browser.errors(), [])

    def test_a_recording_that_is_cut_is_shown_up_to_the_cut(self):
        whole = (self.place / "drive.pcapng").read_bytes()
        (self.place / "cut.pcapng").write_bytes(cut_in_a_block(whole, 2 / 3))
        with View(self.place / "cut.pcapng", *self.how) as view:
            browser = self.open(view.url)
            browser.wait(IS_READ, 60)
            browser.wait('document.querySelector("#run-note").textContent.includes("cut")')
            self.assertGreater(browser.execute_script("return window.deltamap.run.told.scans"), 100)
            self.assertEqual(browser.errors(), [])
        self.assertIn("deltamap: warning: ", view.said)
        self.assertEqual(view.said.count("\n"), 1)
        self.assertEqual(view.process.returncode, 0)

    def test_a_map_alone_and_the_end_of_its_program(self):
        with View(self.place / "m0.yaml", "--port", "0") as view:
            browser = self.open(view.url)
            browser.wait(HAS_MAP)
            browser.wait("document.querySelector('#status').children.length > 2")
            self.assertTrue(browser.execute_script("return document.querySelector('#run-bar').hidden"))
            self.assertEqual(browser.execute_script("return ['#follow', '#history', '#layers-box'].filter((one) => document.querySelector(one).checkVisibility())"), [])
            self.assertEqual(browser.errors(), [])
            browser.save_screenshot(PICTURES / "view-map.png")
        browser.wait('document.body.dataset.link === "lost"')
        self.assertIn("has ended", browser.execute_script("return document.querySelector('#map-note').textContent"))

    def test_fits_every_size(self):
        with View(self.place / "run") as view:
            for name, width, height, mobile in (("phone", 390, 844, True), ("netbook", 1024, 600, False)):
                with self.subTest(size=name):
                    browser = self.open(view.url, width, height, mobile)
                    browser.wait(f"{HAS_MAP} && {IS_READ}")
                    self.assertLessEqual(browser.execute_script("return document.documentElement.scrollWidth"), width)
                    if not mobile:
                        self.assertLessEqual(browser.execute_script("return document.documentElement.scrollHeight"), height)
                    (browser.save_whole_page if mobile else browser.save_screenshot)(PICTURES / f"view-{name}.png")

    def test_two_on_one_port_and_what_cannot_be_viewed_end_at_once(self):
        with View(self.place / "run") as view:
            port = view.url.rstrip("/").rsplit(":", 1)[1]
            other = subprocess.run([BIN / "deltamap", "view", self.place / "run", "--port", port], capture_output=True, text=True, timeout=60)
            self.assertEqual((other.returncode, other.stdout), (1, ""))
            self.assertIn(port, other.stderr)
            self.assertEqual(other.stderr.count("\n"), 1)


if __name__ == "__main__":
    unittest.main(verbosity=2)
