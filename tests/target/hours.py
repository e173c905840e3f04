#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Does the daemon grow? The pipeline of the i386 package, with its threads, store, recording and files, behind a simulated robot for seven
hours of virtual time. Writes its section of docs/results/service.md. As root.
usage: hours.py [--quick] [--seed N] [--out FILE]    --quick: half an hour in place of seven"""
import csv, json, pathlib, subprocess, sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "bench"))
import project
from live_run import program
from measuring import row, table_lines
from project import ROOT

OUT = ROOT / "build/bench-hours"
TITLE = "Seven hours of the pipeline"


def run(seed, hours):
    """The figures by name, what was warned of, and [(hours, heap in MB, resident MB)] on the way."""
    command = program("i386", "deltamap-lab") + ["endurance", "--only", "pipeline", "--minutes", 60 * hours, "--seed", seed, "--jobs", 1, "--scans", "--out", OUT]
    done = subprocess.run([str(part) for part in command], cwd=ROOT, capture_output=True, text=True)
    tables = list(OUT.glob("scans/pipeline*.csv"))
    if len(tables) != 1:
        raise SystemExit("hours: the pipeline told nothing of its memory:\n%s" % done.stderr[-2000:])
    told = [line.split("pipeline: ", 1)[1] for line in done.stderr.splitlines() if "pipeline: " in line]
    figures = {figure["name"]: figure for figure in json.loads((OUT / "summary.json").read_text())["figures"]}
    with open(tables[0]) as table:
        return figures, told, [(float(line["t_s"]) / 3600, float(line["heap_mb"]), float(line["resident_mb"])) for line in csv.DictReader(table)]


def rows(figures, told, course):
    def of(name):
        return next(figure for full, figure in figures.items() if name in full)

    made = [row("heap in use, least of the time before, MB", ", ".join("%.2f" % heap for _, heap, _ in course)),
            row("resident then, MB", ", ".join("%.1f" % resident for _, _, resident in course)),
            row("first and last: heap, resident", "%.2f and %.2f MB, %.1f and %.1f MB" % (course[0][1], course[-1][1], course[0][2], course[-1][2]))]
    growth = of("heap_growth_mb")
    if growth["value"] is not None:  # the run was long enough
        made.append(row("growth of the heap from the fourth hour to the last", "%.2f MB" % growth["value"], "≤ %g MB" % growth["target"]["most"], growth["met"]))
    made.append(row("revisions", "%.0f" % of("revisions")["value"]))
    warnings = of("warnings")
    return made + [row("warnings of what was degraded", "; ".join(["%.0f" % warnings["value"]] + told), "0", warnings["value"] == 0)]


def section(made, course):
    return ["The daemon's own pipeline in the i386 program, with threads, store, recording and files, at 2 scans a second of virtual time in `endurance.yaml`: a hall of",
            "35 m x 35 m where a container is moved each minute, doors open and people pass. The simulator's memory is in it. What is kept of a place is made when it is",
            "first seen: it grows until the hall has been seen whole, in the fourth hour, and is bounded by its area ([memory](../architecture.md#memory)).",
            "Looked at after %s h." % ", ".join("%.2f" % hour for hour, _, _ in course), ""] + table_lines(made)


def of_hours(seed, quick):
    figures, told, course = run(seed, 0.5 if quick else 7)
    made = rows(figures, told, course)
    return section(made, course), all(r["met"] is not False for r in made)


if __name__ == "__main__":
    project.measure_a_section(__doc__, "./dev bench hours", TITLE, of_hours)
