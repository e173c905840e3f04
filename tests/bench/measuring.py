# SPDX-License-Identifier: Apache-2.0
"""What all parts of ./dev bench localization use: programs run, data unpacked, rows of the table."""
import pathlib, sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import project
from project import DATA, ROOT, run

OUT = ROOT / "build/bench-localization"
TOOL = ROOT / "build/release/bin/deltamap"


def row(figure, ours, target="", met=None, peers=""):
    return {"figure": figure, "peers": peers, "ours": ours, "target": target, "met": met}


def unpacked(name):
    return project.unpacked(name, OUT / "data")


def median(values):
    return sorted(values)[len(values) // 2]
