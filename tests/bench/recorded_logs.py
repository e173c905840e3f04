#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Every recorded log on the map of its own building: how far is the pose off, and is the robot ever lost?

    tests/bench/recorded_logs.py OUT [--tool FILE] [--seeds N] [--only TEXT] [--set KEY=VALUE]... [--page [--changes FOLDER]]

Writes OUT/logs.csv, a row a run, which tests/bench/paired.py compares with that of another program (--figure error_median_m). Of `intel` and `wean3`
there are maps; those of the others are drawn here, by counting beams from the reference's poses: a run of the same log on
them is optimistic, as on ref_intel. `uma_loc` is driven on the map of the day before. The map is not updated.

  --page     writes docs/results/recorded.md
  --changes  with a summary of what recorded_changes.py has left in that folder, of the same program
"""
import argparse
import bisect
import csv
import json
import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from project import DATA, ROOT, processor, run, unpacked

TOOLS = DATA.parent / "tools"
sys.path.insert(0, str(TOOLS))
RESOLUTION_M = 0.05
LONGEST_M = 30.0  # of a beam that draws
# The map, how far the laser is ahead of the robot, ranges that are a return, and the logs' odometry (../shared/data/README.md).
LOGS = {
    "intel": ("ref_intel", 0.0, (0.0, 80.0), "raw, poor"),
    "wean3": ("ref_wean3", 0.25, (0.0, 80.0), "raw"),
    "aces": ("aces", 0.0, (0.0, 49.0), "reconstructed"),
    "duke": ("duke", 0.4, (0.0, 8.1), "raw"),  # by its turns on the spot: the log tells the laser by the robot's pose
    "p3dx0": ("p3dx0", 0.0, (0.02, 5.5), "raw, of a P3-DX"),
    "uma_map": ("uma_map", 0.78, (0.0, 31.0), "corrected poses"),
    "uma_loc": ("uma_map", 0.78, (0.0, 31.0), "raw"),
}


def scans_of(log):
    """(stamp, bearing of the first beam, step, ranges) of each scan, rad and m."""
    for line in unpacked("logs/%s.log" % log, OUT / "data").read_text().splitlines():
        words = line.split()
        if line.startswith("FLASER"):
            count = int(words[1])
            step = math.radians(1.0 if count < 200 else 0.5)
            yield float(words[-3]), -0.5 * math.pi, step, [float(word) for word in words[2:2 + count]]
        elif line.startswith("ROBOTLASER1"):
            count = int(words[8])
            yield float(words[-3]), float(words[2]), float(words[4]), [float(word) for word in words[9:9 + count]]


def reference_of(log):
    lines = unpacked("reference/%s.gt.txt" % log, OUT / "data").read_text().splitlines()
    return [tuple(float(word) for word in line.split()) for line in lines if line.strip() and line[0] != "#"]


def poses_of_scans(log):
    reference = reference_of(log)
    times = [row[0] for row in reference]
    for stamp, first, step, ranges in scans_of(log):
        i = min(bisect.bisect_left(times, stamp - 0.002), len(times) - 1)
        if abs(times[i] - stamp) < 0.005:
            yield reference[i][1:], first, step, ranges


def drawn_map(log):
    """Occupied: where at least a quarter of the beams that met the cell ended, and two did; free: where beams went through."""
    import grids
    target = OUT / "data" / (log + ".yaml")
    if target.exists():
        return target
    least, most = LOGS[log][2]
    scans = list(poses_of_scans(log))
    reach = min(LONGEST_M, most)
    low = [min(pose[i] for pose, *_ in scans) - reach for i in (0, 1)]
    size = [int((max(pose[i] for pose, *_ in scans) + reach - low[i]) / RESOLUTION_M) + 1 for i in (0, 1)]
    hits, passes = {}, {}
    for (x, y, theta), first, step, ranges in scans:
        # Beams that lie closer than a cell at the wall say the same twice.
        every = max(1, int(math.radians(0.5) / step))
        for i in range(0, len(ranges), every):
            if not least < ranges[i] < most:
                continue
            c, s = math.cos(theta + first + i * step), math.sin(theta + first + i * step)
            length = min(ranges[i], LONGEST_M)
            seen = set()
            for k in range(int((length - RESOLUTION_M) / (0.5 * RESOLUTION_M))):
                way = 0.5 * RESOLUTION_M * k
                seen.add((int((x + way * c - low[0]) / RESOLUTION_M), int((y + way * s - low[1]) / RESOLUTION_M)))
            end = (int((x + length * c - low[0]) / RESOLUTION_M), int((y + length * s - low[1]) / RESOLUTION_M))
            seen.discard(end)
            for cell in seen:
                passes[cell] = passes.get(cell, 0) + 1
            if length < LONGEST_M:
                hits[end] = hits.get(end, 0) + 1
    cells = [-1] * (size[0] * size[1])
    for (column, row), count in passes.items():
        cells[row * size[0] + column] = 0
    for (column, row), count in hits.items():
        if count >= 2 and count >= 0.25 * (count + passes.get((column, row), 0)):
            cells[row * size[0] + column] = 1
    grids.write(grids.Grid(size[0], size[1], cells, RESOLUTION_M, low), str(target))
    return target


def map_of(log):
    name = LOGS[log][0]
    if not name.startswith("ref_"):
        return drawn_map(name)
    unpacked("maps/%s.pgm" % name, OUT / "data")
    return unpacked("maps/%s.yaml" % name, OUT / "data")


def run_one(tool, log, seed, settings):
    name = "%s-seed%d" % (log, seed)
    _, ahead_m, _, wheels = LOGS[log]
    recording = OUT / "data" / (log + ".pcapng")
    if not recording.exists():
        run(tool, "import", "carmen", unpacked("logs/%s.log" % log, OUT / "data"), recording)
    (x, y, theta), *_ = next(iter(poses_of_scans(log)))
    start = "%.3f,%.3f,%.1f" % (x - ahead_m * math.cos(theta), y - ahead_m * math.sin(theta), math.degrees(theta))
    folder = OUT / "logs" / name
    run(tool, "replay", recording, "--map", map_of(log), "--config", ROOT / "config/pioneer.yaml", "--out", folder, "--seed", seed,
        "--set", "laser.mount.x_m=%g" % ahead_m, "--set", "mapping.enabled=false", "--initial-pose=" + start,
        *(word for setting in settings for word in ("--set", setting)))
    pose = json.loads(run(sys.executable, TOOLS / "score_trajectory.py", folder / "trajectory.tum",
                          DATA / ("reference/%s.gt.txt.xz" % log), "--laser", ahead_m))
    row = {"run": name, "log": log, "wheels": wheels, "scans": pose["of"], "error_median_m": pose["median_m"], "error_p95_m": pose["p95_m"],
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
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("out", help="folder for the result")
    parser.add_argument("--tool", default=ROOT / "build/release/bin/deltamap", help="the program that is measured")
    parser.add_argument("--seeds", type=int, default=3)
    parser.add_argument("--only", default="", help="only runs with this in their name")
    parser.add_argument("--set", action="append", default=[], help="KEY=VALUE over the settings")
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
    with open(OUT / "logs.csv", "w", newline="", encoding="utf-8") as table:
        writer = csv.DictWriter(table, fieldnames=rows[0])
        writer.writeheader()
        writer.writerows(rows)
    if given.page:
        changed = list(csv.DictReader((given.changes / "recorded.csv").open(encoding="utf-8"))) if given.changes else []
        page(given.tool, given.set, rows, changed)


if __name__ == "__main__":
    main()
