#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""What a running daemon tells programs, held against the tables of docs/api.md: ./dev test browser."""

import json
import re
import unittest

from running_daemon import ROOT, RunningDaemon


def documented(title):
    """What the tables of a section name in their first column, as patterns: capitals stand for any name."""
    section = re.search(rf"^## `{title}`\n(.*?)^## ", (ROOT / "docs/api.md").read_text(), re.M | re.S).group(1)
    cells = [line.split(" | ")[0] for line in section.splitlines() if line.startswith("| `")]
    names = [name for cell in cells for name in re.findall(r"`([^`]+)`", cell)]
    return [re.compile(re.sub(r"[A-Z]+", r"[^.]+", name.split("{")[0].replace(".", r"\.")) + "$") for name in names]


def fields(value, path=""):
    """The names of all that is no object, those of objects before a dot."""
    if not isinstance(value, dict):
        return [path]
    return [name for key, inner in value.items() for name in fields(inner, f"{path}.{key}" if path else key)]


class ApiTest(unittest.TestCase):
    def test_every_field_and_metric_is_documented(self):
        with RunningDaemon(places={"recording.file": "drive.pcapng"}) as daemon:
            status = json.loads(daemon.get("/api/status"))
            metrics = set(re.findall(r"^# TYPE deltamap_(\w+)", daemon.get("/metrics").decode(), re.M))
        for title, names in (("/api/status", fields(status)), ("/metrics", metrics)):
            patterns = documented(title)
            self.assertGreater(len(names), 20)
            self.assertEqual([name for name in names if not any(pattern.match(name) for pattern in patterns)], [])


if __name__ == "__main__":
    unittest.main(verbosity=2)
