#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""What the live page works out by itself, held against small examples in Chromium: ./dev test browser."""

import pathlib
import subprocess
import tempfile
import unittest

from browser import Browser
from running_daemon import BIN, WORLD
import view_test

# A room of 4 m by 4 m with a wall 0.5 m in front of its right side: columns 60 and 76 are occupied, what lies behind is unknown.
# The robot stands at 1, 2 m; `words` of beams that end at the given places.
BEAMS = """
const [ends, gap] = arguments;
return Promise.all(["/page/beams.js", "/page/map_view.js"].map((name) => import(name))).then(([beams, { MapView }]) => {
  const view = new MapView(document.createElement("canvas"), () => {});
  view.set_frame({ width: 100, height: 80, resolution_m: 0.05, origin_m: [0, 0] });
  const states = new Uint8Array(100 * 80);
  for (let row = 0; row < 80; ++row) {
    for (let column = 0; column < 100; ++column) {
      const is_gap = column === 60 && row >= gap[0] && row < gap[1];
      states[row * 100 + column] = column > 76 ? 2 : column === 76 || (column === 60 && !is_gap) ? 1 : 0;
    }
  }
  view.set_cells({ revision: 0, column: 0, row: 0, width: 100, height: 80, states });
  return [...beams.beam_words(view, { x: 1, y: 2, heading: 0 }, Float32Array.from(ends.flat()))];
});"""
FITS, SHORT, THROUGH, NOT_KNOWN = range(4)


class RulesTest(unittest.TestCase):
    """One page, of a map alone."""

    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory(prefix="deltamap-rules-")
        cls.addClassCleanup(cls.folder.cleanup)
        file = pathlib.Path(cls.folder.name) / "m0.yaml"
        subprocess.run([BIN / "deltamap", "sim", "--world", WORLD, "--write-map", file], check=True, capture_output=True)
        cls.view = view_test.View(file)
        cls.addClassCleanup(cls.view.__exit__)
        cls.browser = Browser()
        cls.addClassCleanup(cls.browser.quit)
        cls.browser.get(cls.view.url)
        cls.browser.wait(view_test.HAS_MAP)

    def words(self, *ends, gap=(0, 0)):
        return self.browser.execute_script(BEAMS, [list(end) for end in ends], list(gap))

    def test_a_beam_says_what_it_means_for_the_map(self):
        self.assertEqual(self.words((3.02, 2), (2.9, 2), (2.0, 2), (0.2, 0.3)), [FITS, FITS, SHORT, SHORT])
        self.assertEqual(self.words((4.5, 2), gap=(0, 80)), [THROUGH], "the wall behind")
        self.assertEqual(self.words((1, 5)), [NOT_KNOWN])

    def test_a_beam_that_ends_on_the_wall_behind_an_obstacle_has_gone_through_it(self):
        self.assertEqual(self.words((3.82, 2), (3.82, 2.6), (3.5, 2)), [THROUGH] * 3)
        self.assertEqual(self.words((3.2, 2)), [SHORT], "less than 0.3 m behind it")
        self.assertEqual(self.words((3.82, 2), gap=(30, 50)), [FITS], "by a door")

    def test_a_beam_that_grazes_an_edge_has_gone_through_nothing(self):
        # At the wall it passes 0.05 m inside the edge of a gap that ends at 2 m.
        self.assertEqual(self.words((3.82, 2.07), gap=(20, 40)), [FITS])
        self.assertEqual(self.words((3.82, 2.6), gap=(20, 40)), [THROUGH])

    def test_axes_fit_the_data(self):
        axis = lambda low, high: self.browser.execute_script("""const [low, high] = arguments;
            return import("/page/charts.js").then(({ axis_for }) => { const axis = axis_for(low, high); return [axis.low, axis.high] })""", low, high)
        for (low, high), (least, most) in {(0.1, 0.9): (0, 1), (80, 100): (80, 100), (0.97, 0.99): (0.97, 0.99), (0, 0): (-0.5, 0.5), (-1.1, -0.1): (-1.5, 0), (500, 500): (450, 550), (9.383, 9.386): (9.25, 9.5)}.items():
            self.assertAlmostEqual(axis(low, high)[0], least, 6, (low, high))
            self.assertAlmostEqual(axis(low, high)[1], most, 6, (low, high))

    def test_cells_are_counted_in_the_same_words_everywhere(self):
        texts = self.browser.execute_script("""return import("/page/cell_text.js").then(({ cell_text }) =>
            [{ occupied: 1024, forgotten: 3 }, { free: 1 }, {}].map(cell_text))""")
        self.assertEqual(texts, ["1,024 occupied, 3 forgotten", "1 free", ""])

    def test_the_driving_state_says_why_nobody_may_drive(self):
        drives = {"drive": "wander", "stopped_by": "none", "never_driven": "", "may_drive_by_pose": True, "forbidden_by": "none"}
        rows = lambda **status: self.browser.execute_script("""const [status] = arguments;
            return import("/page/panels.js").then(({ driving_rows }) => driving_rows(status).map(([name, text]) => `${name}: ${text}`))""", {**drives, **status})
        self.assertEqual(rows(), ["Driving: wander", "Planners: may drive by this pose"])
        self.assertEqual(rows(stopped_by="laser sees nothing", may_drive_by_pose=False, forbidden_by="laser sees nothing"),
                         ["Driving: wander; stands: laser sees nothing", "Planners: must not drive by this pose: laser sees nothing"])
        self.assertEqual(rows(drive="off", stopped_by="no command", may_drive_by_pose=False, forbidden_by="stalled"),
                         ["Driving: off", "Planners: must not drive by this pose: stalled"])
        p3at = 'its subtype "p3at" is unknown: set its hull'
        self.assertEqual(rows(drive="off", never_driven=p3at, may_drive_by_pose=False, forbidden_by="unknown robot"),
                         [f"Driving: not driven: {p3at}", "Planners: must not drive by this pose: unknown robot"])

    def test_times_are_written_the_same_in_every_language(self):
        texts = self.browser.execute_script("""return import("/page/time_text.js").then(({ clock, date_and_clock }) => {
            const time = new Date(2026, 0, 5, 0, 7, 9) / 1000;
            return [clock(time), date_and_clock(time)];
        })""")
        self.assertEqual(texts, ["00:07:09", "2026-01-05 00:07:09"])


if __name__ == "__main__":
    unittest.main(verbosity=2)
