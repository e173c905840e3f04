#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Every recorded log on the map of its own building: how far is the pose off, and is the robot ever lost?

    tests/bench/recorded_logs.py OUT [--tool FILE] [--seeds N] [--only TEXT] [--set KEY=VALUE]... [--page [--changes FOLDER]]

Writes OUT/logs.csv, a row a run, which tests/bench/paired.py compares with that of another program (--figure error_median_m).
Of `intel` and `wean3` there are maps; those of the others are drawn from the reference's poses by `deltamap map from-poses`:
a run of the same log on them is optimistic, as on ref_intel. `uma_loc` is driven on the map of the day before. The map is not updated.

  --page     writes docs/results/recorded.md
  --changes  with a summary of what recorded_changes.py has left in that folder, of the same program
"""
import csv
import math
import pathlib

import recorded
from project import processor
from recorded import AHEAD_M, ROOT, run, unpacked

# The map, and the log's odometry (../shared/data/README.md).
LOGS = {"intel": ("ref_intel", "raw, poor"), "wean3": ("ref_wean3", "raw"), "aces": ("aces", "reconstructed"), "duke": ("duke", "raw"),
        "p3dx0": ("p3dx0", "raw, of a P3-DX"), "uma_map": ("uma_map", "corrected poses"), "uma_loc": ("uma_map", "raw")}
LASER_WORDS = {"FLASER": slice(-9, -6), "ROBOTLASER1": slice(-14, -11)}  # of a line: x y theta of the laser


def drawn_map(tool, log):
    """By the scans of the log that the reference has poses of."""
    target = OUT / "data" / (log + ".yaml")
    if target.exists():
        return target
    poses = {round(row[0], 3): row[1:] for row in recorded.reference_of(log, OUT / "data")}
    corrected = OUT / "data" / (log + "-corrected.log")
    with open(corrected, "w", encoding="utf-8") as out:
        for line in unpacked("logs/%s.log" % log, OUT / "data").read_text().splitlines():
            words = line.split()
            pose = poses.get(round(float(words[-3]), 3)) if words and words[0] in LASER_WORDS else None
            if pose:
                words[LASER_WORDS[words[0]]] = ["%.6f" % part for part in pose]
                out.write(" ".join(words) + "\n")
    run(tool, "map", "from-poses", corrected, target)
    return target


def map_of(tool, log):
    name, _ = LOGS[log]
    if not name.startswith("ref_"):
        return drawn_map(tool, name)
    unpacked("maps/%s.pgm" % name, OUT / "data")
    return unpacked("maps/%s.yaml" % name, OUT / "data")


def run_one(tool, log, seed, settings):
    name = "%s-seed%d" % (log, seed)
    recording = OUT / "data" / (log + ".pcapng")
    if not recording.exists():
        run(tool, "import", "carmen", unpacked("logs/%s.log" % log, OUT / "data"), recording)
    _, x, y, theta = recorded.reference_of(log, OUT / "data")[0]
    start = "%.3f,%.3f,%.1f" % (x - AHEAD_M[log] * math.cos(theta), y - AHEAD_M[log] * math.sin(theta), math.degrees(theta))
    pose = recorded.replayed(tool, log, recording, map_of(tool, log), OUT / "logs" / name, seed, ["mapping.enabled=false", *settings],
                             "--initial-pose=" + start)
    row = {"run": name, "log": log, "wheels": LOGS[log][1], "scans": pose["of"], "error_median_m": pose["median_m"], "error_p95_m": pose["p95_m"],
           "error_most_m": pose["max_m"], "off_share": pose["lost"], "coverage": pose["coverage"]}
    print("%(run)-16s median %(error_median_m)-7s 95 %% %(error_p95_m)-7s most %(error_most_m)-7s lost %(off_share)s" % row, flush=True)
    return row


def worst(rows, key):
    return max(float(row[key]) for row in rows)


def page(tool, settings, rows, changed):
    lines = ["# Recorded logs", "",
             "Written by `tests/bench/recorded_logs.py --page` from what it and `recorded_changes.py` have replayed: %s on %s%s."
             % (run(tool, "--version").strip(), processor(), ", " + ", ".join(settings) if settings else ""), "",
             "## Each on the map of its own building", "",
             "The map is not updated. Maps but those of `intel` and `wean3` are drawn from the reference's poses. Of some seeds the worst;",
             "lost: share of the scans that are more than 0.5 m off, or have no pose.", "",
             "| log | wheels | scans | seeds | median, m | 95 %, m | farthest, m | lost |", "|---|---|---|---|---|---|---|---|"]
    for log in LOGS:
        of = [row for row in rows if row["log"] == log]
        if of:
            lines.append("| `%s` | %s | %s | %d | %.3f | %.3f | %.2f | %.4f |" % (
                log, of[0]["wheels"], of[0]["scans"], len(of), worst(of, "error_median_m"), worst(of, "error_p95_m"),
                worst(of, "error_most_m"), worst(of, "off_share")))
    if changed:
        lines += ["", "## On maps that were made out of date, the map live", "",
                  "Ten things erased and ten added for each seed; `poor`: wheels made of the reference, 2 % too far, 0.3° a metre, 120 ms late;",
                  "`worse`: those of the log with the same errors on top; `global`: the start is not given. Means over the seeds.", "",
                  "| log, wheels | seeds | revisions | found | skill | kept | ghosts, m² | median, m | lost | gate shut |", "|---|---|---|---|---|---|---|---|---|---|"]
        kinds = sorted({row["run"].rsplit("-seed", 1)[0] for row in changed})
        for kind in kinds:
            of = [row for row in changed if row["run"].rsplit("-seed", 1)[0] == kind]
            mean = lambda key: sum(float(row[key]) for row in of) / len(of)
            lines.append("| `%s` | %d | %.0f | %.2f | %.3f | %.4f | %.2f | %.3f | %.4f | %.3f |" % (
                kind, len(of), mean("revisions"), mean("recall"), mean("skill"), mean("walls_kept"), mean("ghost_m2"), mean("error_median_m"),
                mean("off_share"), mean("shut_share")))
    (ROOT / "docs/results/recorded.md").write_text("\n".join(lines) + "\n")


def main():
    global OUT
    parser = recorded.options(__doc__, seeds=3)
    parser.add_argument("--page", action="store_true")
    parser.add_argument("--changes", type=pathlib.Path, help="folder of recorded_changes.py, for the page")
    given = parser.parse_args()
    if given.page and given.only:
        parser.error("a page is of all logs: --page without --only")
    OUT = pathlib.Path(given.out).resolve()
    (OUT / "data").mkdir(parents=True, exist_ok=True)
    rows = [run_one(given.tool, log, seed, given.set) for log in LOGS for seed in range(1, given.seeds + 1)
            if given.only in "%s-seed%d" % (log, seed)]
    if not rows:
        raise SystemExit("recorded_logs: no run has %r in its name" % given.only)
    recorded.write_table(OUT / "logs.csv", rows)
    if given.page:
        changed = list(csv.DictReader((given.changes / "recorded.csv").open(encoding="utf-8"))) if given.changes else []
        page(given.tool, given.set, rows, changed)


if __name__ == "__main__":
    main()
