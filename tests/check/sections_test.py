#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""A document that several programs write, each its own section."""
import json, pathlib, sys, tempfile, unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import project


class Sections(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.file = pathlib.Path(folder.name) / "service.md"

    def test_makes_the_document_with_its_first_section(self):
        project.write_section(self.file, "Crashes", ["none"])
        self.assertEqual(self.file.read_text(), "# Service\n\n## Crashes\n\nnone\n")

    def test_a_new_section_goes_to_the_end_and_an_old_one_is_replaced_in_its_place(self):
        project.write_section(self.file, "Crashes", ["none", "", "| a |"])
        project.write_section(self.file, "Load", ["little", ""])
        project.write_section(self.file, "Crashes", ["one"])
        self.assertEqual(self.file.read_text(), "# Service\n\n## Crashes\n\none\n\n## Load\n\nlittle\n")

    def test_what_is_written_again_changes_nothing(self):
        for title in ("Crashes", "Load"):
            project.write_section(self.file, title, ["some", "", "### below", "", "more"])
        before = self.file.read_text()
        project.write_section(self.file, "Crashes", ["some", "", "### below", "", "more"])
        self.assertEqual(self.file.read_text(), before)

    def test_settings_tell_of_no_place_on_the_machine(self):
        report = self.file.parent / "demo-1" / "run" / "report.json"
        report.parent.mkdir(parents=True)
        changed = {"dashboard.token_file": "/home/robot/token", "map.store": "/home/robot/maps", "navigation.mode": "wander"}
        report.write_text(json.dumps({"settings": {"changed": changed}}))
        self.assertEqual(project.settings_section([report])[-1], '- demo-1 (seeds 1): navigation.mode: "wander"')


if __name__ == "__main__":
    unittest.main()
