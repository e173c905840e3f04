#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Which commit a build says it is from: in a repository, with changes, in a tarball. Called with cmake's path."""
import pathlib, shutil, subprocess, sys, tempfile, time, unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
CMAKE = sys.argv.pop(1)
IDENTITY = ["-c", "user.name=n", "-c", "user.email=e"]


@unittest.skipUnless(shutil.which("git"), "no git on this machine")
class Commit(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.source = pathlib.Path(folder.name).resolve() / "source"
        self.target = self.source.parent / "commit.cpp"
        (self.source / "docs/results").mkdir(parents=True)
        (self.source / "file").write_text("1")
        (self.source / "docs/results/table.md").write_text("1")

    def git(self, *words, at=None):
        return subprocess.run(["git", *IDENTITY, "-C", str(at or self.source), *words], check=True, capture_output=True, text=True).stdout.strip()

    def repository(self, at=None):
        self.git("init", "-q", at=at)
        self.git("add", ".", at=at)
        self.git("commit", "-qm", "first", at=at)
        return self.git("rev-parse", "--short", "HEAD", at=at)

    def told(self):
        subprocess.run([CMAKE, "-DSOURCE=%s" % self.source, "-DTARGET=%s" % self.target, "-P", str(ROOT / "cmake/commit.cmake")], check=True)
        return self.target.read_text().split('return "')[1].split('"')[0]

    def test_names_the_commit_and_whether_there_are_changes(self):
        head = self.repository()
        self.assertEqual(self.told(), head)
        (self.source / "docs/results/table.md").write_text("2")
        self.assertEqual(self.told(), head, "results that are written on the way do not count")
        (self.source / "file").write_text("2")
        self.assertEqual(self.told(), head + "-dirty")

    def test_leaves_the_file_alone_where_nothing_has_changed(self):
        self.repository()
        self.told()
        before = self.target.stat().st_mtime_ns
        time.sleep(0.01)
        self.told()
        self.assertEqual(self.target.stat().st_mtime_ns, before)

    def test_a_tarball_is_of_an_unknown_commit(self):
        self.assertEqual(self.told(), "unknown")
        self.repository(at=self.source.parent)
        self.assertEqual(self.told(), "unknown", "a repository around it is another project")

    def test_a_copy_without_a_repository_is_of_the_commit_that_it_brings(self):
        (self.source / "COMMIT").write_text("fc42533-dirty\n")
        self.assertEqual(self.told(), "fc42533-dirty")
        head = self.repository()
        self.assertEqual(self.told(), head, "a repository knows better")


if __name__ == "__main__":
    unittest.main()
