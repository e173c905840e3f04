# SPDX-License-Identifier: Apache-2.0
"""What the programs that measure and write tables share: programs run, data unpacked, rows and tables."""
import pathlib, sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import project
from project import DATA, ROOT, processor, provenance, run, settings_section, told

OUT = ROOT / "build/bench-localization"
TOOL = ROOT / "build/release/bin/deltamap"
LAB = ROOT / "build/release/bin/deltamap-lab"


def row(figure, ours, target="", met=None, peers=""):
    return {"figure": figure, "peers": peers, "ours": ours, "target": target, "met": met}


def unpacked(name):
    return project.unpacked(name, OUT / "data")


def median(values):
    return sorted(values)[len(values) // 2]


NOTHING = "nothing to measure"


def number(value):
    return NOTHING if value is None else "%.4g" % value


def with_unit(value, unit):
    return number(value) if value is None else ("%s %s" % (number(value), unit)).strip()


def target_of(figure):
    """What a figure of a summary.json is to reach."""
    bounds = figure.get("target", {})
    return ", ".join("%s %s" % (sign, with_unit(bounds[side], figure["unit"]))
                     for side, sign in (("least", "≥"), ("most", "≤")) if side in bounds)


def row_of_figure(figure, prefix=""):
    return row(prefix + figure["name"], with_unit(figure["value"], figure["unit"]), target_of(figure), figure.get("met"),
               figure.get("peers", ""))


def mark(row):
    if row["met"] is False and row["ours"] == NOTHING:
        return "**nothing measured**"
    return {True: "met", False: "**missed**", None: ""}[row["met"]]


def in_a_cell(text):
    return text.replace("|", "\\|")


def table_lines(rows, others="peers"):
    lines = ["| figure | %s | ours | at least | |" % others, "|---|---|---|---|---|"]
    for row in rows:
        texts = [in_a_cell(row[name]) for name in ("figure", "peers", "ours", "target")]
        lines.append("| %s | %s |" % (" | ".join(texts), mark(row)))
    return lines
