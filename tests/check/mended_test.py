#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The writer of docs/results/mended.md, with a build that is not there."""
import json, pathlib, sys, tempfile, unittest
from contextlib import redirect_stdout
from io import StringIO
from unittest import mock

sys.path.insert(0, str(pathlib.Path(__file__).parent))
import mended

RAN = {"Stop.Stays": (mended.PASSED, "noise\nfigure moved = 0 m\n"), "Stop.Brakes": (mended.FAILED, "figure travel = 1.2 m\n"),
       "Log.Cut/0": (mended.PASSED, ""), "Log.Cut/1": (mended.PASSED, "figure cuts = 1000\n"), "Data.IsThere": (mended.SKIPPED, "")}


class Writer(unittest.TestCase):
    def write(self, rows, *words):
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            (root / "rows.json").write_text(json.dumps(rows))
            with mock.patch.multiple(mended, ROOT=root, ROWS=root / "rows.json", RESULT=root / "mended.md", known_tests=lambda: list(RAN),
                                     ran_by_ctest=lambda names: {name: RAN[name] for name in names}, provenance=lambda: "deltamap 0.1.0 (commit abc)"), \
                    mock.patch.object(sys, "argv", ["mended.py", *words]), redirect_stdout(StringIO()):
                with self.assertRaises(SystemExit) as end:
                    mended.main()
            self.code = end.exception.code
            return (root / "mended.md").read_text() if (root / "mended.md").exists() else ""

    def test_sets_before_beside_after_with_the_figures_that_the_test_printed(self):
        text = self.write([{"point": 1, "what": "stays off", "tests": ["Stop.Stays"], "before": "drove", "after": "moved {moved}"}])
        self.assertIn("| 1 | stays off | `Stop.Stays` | drove | moved 0 m | passed |", text)
        self.assertIn("deltamap 0.1.0 (commit abc). 1 of 1 rows passed.", text)
        self.assertEqual(self.code, 0)

    def test_a_test_that_is_not_there_is_shown_and_fails_the_row(self):
        text = self.write([{"point": 2, "what": "brakes", "tests": ["Stop.Stays", "Stop.Gone"], "before": "-"}])
        self.assertIn("| 2 | brakes | `Stop.Stays`<br>`Stop.Gone` **missing** | - | moved 0 m | **missing** |", text)
        self.assertEqual(self.code, 1)

    def test_a_failed_test_counts_before_a_missing_one(self):
        text = self.write([{"point": 2, "what": "brakes", "tests": ["Stop.Gone", "Stop.Brakes"], "before": "-"}])
        self.assertIn("travel 1.2 m | **failed** |", text)

    def test_a_skipped_test_does_not_count_as_passed(self):
        self.assertIn("| **skipped** |", self.write([{"point": 2, "what": "data", "tests": ["Data.IsThere"], "before": "-"}]))
        self.assertEqual(self.code, 1)

    def test_a_pattern_stands_for_all_its_tests(self):
        self.assertIn("| `Log.*` | 20 refused | cuts 1000 | passed |", self.write([{"point": 5, "what": "cuts", "tests": ["Log.*"], "before": "20 refused"}]))

    def test_a_command_passes_by_its_exit_code(self):
        text = self.write([{"point": 9, "what": "one", "tests": ["$ echo figure kills = 200"], "before": "-"},
                           {"point": 3, "what": "other", "tests": ["$ false"], "before": "-"}])
        self.assertIn("| kills 200 | passed |", text)
        self.assertLess(text.index("| 3 | other"), text.index("| 9 | one"))
        self.assertIn("| 3 | other | `$ false` **failed** | - |  | **failed** |", text)

    def test_a_figure_that_nobody_printed_is_named(self):
        text = self.write([{"point": 1, "what": "x", "tests": ["Stop.Stays"], "before": "-", "after": "{speed}"}])
        self.assertIn("(speed: not measured)", text)

    def test_single_points_are_run_without_writing(self):
        rows = [{"point": 1, "what": "x", "tests": ["Stop.Stays"], "before": "-"}, {"point": 2, "what": "y", "tests": ["Gone.Gone"], "before": "-"}]
        self.assertEqual(self.write(rows, "--point", "1"), "")
        self.assertEqual(self.code, 0)


if __name__ == "__main__":
    unittest.main()
