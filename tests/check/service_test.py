#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The writer of what the service is promised, with a build that is not there."""
import json, pathlib, sys, tempfile, unittest
from contextlib import redirect_stdout
from io import StringIO
from unittest import mock

sys.path.insert(0, str(pathlib.Path(__file__).parent))
import service
from service import FAILED, PASSED, SKIPPED

RAN = {"Stop.Stays": PASSED, "Stop.Brakes": FAILED, "Log.Cut/0": PASSED, "Log.Cut/1": PASSED, "Data.IsThere": SKIPPED}


class Writer(unittest.TestCase):
    def write(self, *rows):
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            (root / "rows.json").write_text(json.dumps(rows))
            with mock.patch.multiple(service, ROWS=root / "rows.json", RESULT=root / "service.md", known_tests=lambda: list(RAN),
                                     outcomes_by_ctest=lambda names: {name: RAN[name] for name in names}, provenance=lambda: "deltamap 0.1.0 (commit abc)",
                                     exposure=lambda: ("exposure", "1.2", PASSED), lintian=lambda: ("lintian", "no package here", SKIPPED)), \
                    redirect_stdout(StringIO()), self.assertRaises(SystemExit) as end:
                service.main()
            self.code = end.exception.code
            return (root / "service.md").read_text()

    def test_sets_tests_and_outcome_beside_the_promise(self):
        text = self.write({"part": "operator", "what": "stays | off", "tests": ["Stop.Stays"]})
        self.assertIn("| operator | stays \\| off | `Stop.Stays` | passed |", text)
        self.assertIn("deltamap 0.1.0 (commit abc).", text)
        self.assertEqual(self.code, 0)

    def test_a_test_that_is_not_there_is_shown_and_fails_the_row(self):
        text = self.write({"part": "operator", "what": "brakes", "tests": ["Stop.Stays", "Stop.Gone"]})
        self.assertIn("| brakes | `Stop.Stays`<br>`Stop.Gone` **missing** | **missing** |", text)
        self.assertEqual(self.code, 1)

    def test_a_failed_test_counts_before_a_missing_one(self):
        text = self.write({"part": "operator", "what": "brakes", "tests": ["Stop.Gone", "Stop.Brakes"]})
        self.assertIn("`Stop.Brakes` **failed** | **failed** |", text)
        self.assertEqual(self.code, 1)

    def test_a_skipped_test_does_not_count_as_passed(self):
        self.assertIn("`Data.IsThere` **skipped** | **skipped** |", self.write({"part": "x", "what": "data", "tests": ["Data.IsThere"]}))

    def test_a_pattern_stands_for_all_its_tests(self):
        self.assertIn("| cuts | `Log.*` | passed |", self.write({"part": "x", "what": "cuts", "tests": ["Log.*"]}))
        self.assertIn("| stops | `Stop.*` **failed** | **failed** |", self.write({"part": "x", "what": "stops", "tests": ["Stop.*"]}))


if __name__ == "__main__":
    unittest.main()
