#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Every link of every document leads somewhere: to a file of the tree, to a heading of it, and, from what the package installs, to
what it installs too."""
import pathlib, re, unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
BUILT = {"build", ".git"}


def documents():
    return [file for file in sorted(ROOT.rglob("*.md")) if file.relative_to(ROOT).parts[0] not in BUILT]


def links(file):
    """(path, heading) of each link within the project."""
    found = re.findall(r"\]\(([^)\s]+)\)", file.read_text())
    return [target.partition("#")[::2] for target in found if not re.match(r"[a-z]+:", target)]


def headings(file):
    """The anchors of a document, as they are made from its headings."""
    titles = (re.sub(r"[`*]", "", line.lstrip("#")).strip() for line in file.read_text().splitlines() if re.match("#+ ", line))
    shown = (re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", title).lower() for title in titles)
    return {re.sub(r"[^\w\- ]", "", title).replace(" ", "-") for title in shown}


def installed():
    """Files and folders that debian/deltamap.docs puts beside each other, by their places in the tree."""
    return [ROOT / line for line in (ROOT / "debian/deltamap.docs").read_text().split()]


class Links(unittest.TestCase):
    def test_lead_to_a_file_and_a_heading(self):
        for file in documents():
            for path, heading in links(file):
                target = file.parent / path if path else file
                with self.subTest("%s: %s#%s" % (file.relative_to(ROOT), path, heading)):
                    self.assertTrue(target.exists())
                    if heading and target.suffix == ".md":
                        self.assertIn(heading, headings(target))

    def test_of_installed_documents_lead_to_installed_ones(self):
        places = installed()
        inside = [file for file in documents() if any(place == file or place in file.parents for place in places)]
        self.assertGreater(len(inside), 50)
        for file in inside:
            for path, _ in links(file):
                target = (file.parent / path).resolve()
                with self.subTest("%s: %s" % (file.relative_to(ROOT), path)):
                    self.assertTrue(any(place == target or place in target.parents for place in places))

    def test_of_installed_documents_lead_to_files_that_are_not_compressed(self):
        """dh_compress gives whatever is larger than 4 KiB another name, but for pictures, pages and what debian/rules leaves out."""
        left_out = re.findall(r"--exclude=(\S+)", (ROOT / "debian/rules").read_text())
        stay = {".png", ".gif", ".jpg", ".html", ".gz"}
        for file in (file for place in installed() for file in ([place] if place.is_file() else place.rglob("*.md"))):
            for path, _ in links(file):
                target = (file.parent / path).resolve()
                if target.is_file() and target.stat().st_size > 4096 and target.suffix not in stay:
                    with self.subTest("%s: %s" % (file.relative_to(ROOT), path)):
                        self.assertTrue(any(part in "/" + str(target.relative_to(ROOT)) for part in left_out))


if __name__ == "__main__":
    unittest.main()
