#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The writer of docs/results/experiments.md, with experiments that are not there."""
import io, pathlib, sys, tempfile, unittest
from contextlib import redirect_stdout
from unittest import mock

sys.path.insert(0, str(pathlib.Path(__file__).parent))
import experiments


def summary(name, value, met):
    return {"experiment": name, "seed": 3, "quick": False, "runs": 2, "met": met,
            "figures": [{"name": "error", "value": value, "unit": "m", "target": {"most": 0.05}, "met": met, "peers": "paper < 0.5"},
                        {"name": "a | b", "value": None, "unit": ""}]}


class Writer(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.root = pathlib.Path(self.folder.name)
        (self.root / "docs/results").mkdir(parents=True)
        self.measured = {"one": (0.04, True), "two": (0.06, False)}
        self.jobs = {}

    def write(self, *words):
        def done(name, measures_machine, arguments, folder):
            self.jobs[name] = measures_machine
            return summary(name, *self.measured[name])

        with mock.patch.multiple(experiments, ROOT=self.root, OUT=self.root / "build", done=done, revision=lambda: self.revision,
                                 experiments=lambda: {"one": (False, "The first"), "two": (True, "The second")}), \
                mock.patch.object(sys, "argv", ["experiments.py", *words]), redirect_stdout(io.StringIO()):
            with self.assertRaises(SystemExit) as end:
                experiments.main()
        return end.exception.code

    def text(self):
        return (self.root / "docs/results/experiments.md").read_text()

    def test_sets_the_papers_numbers_beside_ours(self):
        self.revision = "aaa1"
        self.assertEqual(self.write(), 1)
        self.assertIn("| error | paper < 0.5 | 0.04 m | ≤ 0.05 m | met |", self.text())
        self.assertIn("| error | paper < 0.5 | 0.06 m | ≤ 0.05 m | **missed** |", self.text())
        self.assertIn("1 of 2 figures met", self.text())

    def test_says_where_nothing_was_measured_and_breaks_no_table(self):
        self.revision = "aaa1"
        self.write()
        self.assertIn("| a \\| b |  | nothing to measure |  |  |", self.text())

    def test_tells_a_target_for_which_nothing_was_measured_from_one_that_was_missed(self):
        self.revision = "aaa1"
        self.measured["two"] = (None, False)
        self.assertEqual(self.write(), 1)
        self.assertIn("| error | paper < 0.5 | nothing to measure | ≤ 0.05 m | **nothing measured** |", self.text())
        self.assertNotIn("missed", self.text())

    def test_keeps_the_others_with_their_revision_where_one_is_done_anew(self):
        self.revision = "aaa1"
        self.write()
        self.revision, self.measured["two"] = "bbb2", (0.01, True)
        self.assertEqual(self.write("--only", "two"), 0)
        self.assertIn("The first. 2 runs from seed 3, at aaa1. 1 of 1 met.", self.text())
        self.assertIn("The second. 2 runs from seed 3, at bbb2. 1 of 1 met.", self.text())
        self.assertLess(self.text().index("## one"), self.text().index("## two"))

    def test_names_program_and_settings_where_the_summary_does(self):
        self.revision = "aaa1"
        known = summary
        made_by = {"version": "0.1.0", "commit": "ccc3", "settings": {"fingerprint": "00ff", "changed": {"mapping.method": "paper"}}}
        with mock.patch.dict(globals(), summary=lambda *what: {**known(*what), **made_by}):
            self.write()
        self.assertIn('from seed 3, version 0.1.0, commit ccc3, settings 00ff: mapping.method: "paper". 1 of 1 met.', self.text())

    def page_of_two(self, seed=None):
        return experiments.Page("docs/results/two.md", "# Two, on %s: %s.\n", "Nobody asked.", seed)

    def test_leaves_the_report_alone_when_quick(self):
        self.revision = "aaa1"
        self.write("--quick")
        self.assertFalse((self.root / "docs/results/experiments.md").exists())
        self.assertTrue((self.root / "build/quick/experiments.md").exists())

    def test_gives_an_experiment_of_tables_a_page_of_its_own(self):
        self.revision = "aaa1"
        tables = {"version": "0.1.0", "commit": "ccc3", "settings": {"fingerprint": "00ff", "changed": {}},
                  "tables": [{"title": "Off", "columns": ["change", "jumps"], "rows": [["off-x", "+1 [0, +2] 0:3"]]},
                             {"title": "On", "columns": ["change"], "rows": []}]}
        known = summary
        self.measured["one"] = (0.04, True)
        with mock.patch.dict(globals(), summary=lambda *what: {**known(*what), **tables}), \
                mock.patch.object(experiments, "PAGES", {"two": self.page_of_two()}):
            self.write()
        page = (self.root / "docs/results/two.md").read_text()
        self.assertIn("# Two, on ", page)
        self.assertIn("| off-x | +1 [0, +2] 0:3 |", page)
        self.assertIn("## On\n\nNobody asked.", page)
        self.assertNotIn("## two", self.text())
        self.assertNotIn("off-x", self.text())

    def test_leaves_a_page_alone_that_other_seeds_are_asked_for(self):
        self.revision = "aaa1"
        tables = {"version": "0.1.0", "commit": "ccc3", "settings": {"fingerprint": "00ff", "changed": {}}, "tables": []}
        known = summary
        with mock.patch.dict(globals(), summary=lambda *what: {**known(*what), **tables}), \
                mock.patch.object(experiments, "PAGES", {"two": self.page_of_two(seed=1000)}):
            self.write()
        self.assertFalse((self.root / "docs/results/two.md").exists())
        self.assertTrue((self.root / "build/full/two.md").exists())

    def test_refuses_a_name_that_there_is_not(self):
        self.revision = "aaa1"
        with mock.patch("sys.stderr", io.StringIO()) as errors:
            self.assertEqual(self.write("--only", "tow"), 2)
        self.assertIn("no experiment tow; there are one, two", errors.getvalue())


if __name__ == "__main__":
    unittest.main()
