#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The paired comparison of two results, on made-up tables."""
import io, pathlib, sys, tempfile, unittest
from contextlib import redirect_stdout

sys.path.insert(0, str(pathlib.Path(__file__).parent))
import paired


class Comparison(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.root = pathlib.Path(self.folder.name)

    def results(self, name, rows):
        folder = self.root / name
        folder.mkdir()
        lines = ["run,layout,error_rms_m,recall"] + ["%s,hall,%s,%s" % row for row in rows]
        (folder / "unseen.csv").write_text("\n".join(lines) + "\n")
        return folder

    def test_counts_pairs_by_what_is_better_and_leaves_out_what_is_not_in_both(self):
        before = paired.runs_in(self.results("a", [("s1", 0.1, 0.9), ("s2", 0.2, ""), ("s3", 0.3, 0.7), ("s4", 1, 1)]))
        after = paired.runs_in(self.results("b", [("s3", 0.1, 0.8), ("s1", 0.2, 0.9), ("s2", 0.1, 0.5), ("s5", 1, 1)]))
        error = paired.compared(before, after, "error_rms_m")
        self.assertEqual((error["runs"], error["better"], error["worse"]), (3, 2, 1))
        self.assertEqual(error["before"], [0.2, 0.3, 0.3])
        recall = paired.compared(before, after, "recall")
        self.assertEqual((recall["runs"], recall["better"], recall["worse"]), (2, 1, 0))
        self.assertEqual(recall["before"], [0.9, 0.7, 0.7], "more is better: the worst is the least")
        self.assertIsNone(paired.compared(before, after, "layout"))
        self.assertIsNone(paired.compared(before, after, "no such figure"))

    def test_sign_test_tells_chance_from_change(self):
        self.assertEqual(paired.sign_test(0, 0), 1.0)
        self.assertEqual(paired.sign_test(5, 5), 1.0)
        self.assertAlmostEqual(paired.sign_test(10, 0), 2.0 / 1024)
        self.assertAlmostEqual(paired.sign_test(1, 9), 22.0 / 1024)

    def test_prints_a_line_for_every_figure(self):
        before = self.results("a", [("s1", 0.1, 0.9), ("s2", 0.2, 0.8)])
        after = self.results("b", [("s1", 0.05, 0.9), ("s2", 0.1, 0.9), ("s3", 1, 1)])
        out = io.StringIO()
        with redirect_stdout(out):
            paired.main([str(before), str(after)])
        lines = out.getvalue().splitlines()
        self.assertEqual(len(lines), 4)
        self.assertIn("error_rms_m", lines[1])
        self.assertIn("1 runs are in one folder only", lines[3])

    def test_refuses_folders_that_cannot_be_compared_in_one_line(self):
        before = self.results("a", [("s1", 0.1, 0.9)])
        other = self.results("b", [("s2", 0.1, 0.9)])
        for arguments in ([str(before), str(other)], [str(before), str(self.root)],
                          [str(before), str(before), "--figure", "nothing"]):
            with self.assertRaises(SystemExit) as end:
                paired.main(arguments)
            self.assertTrue(str(end.exception).startswith("paired: "))
            self.assertNotIn("\n", str(end.exception))


if __name__ == "__main__":
    unittest.main()
