#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The same recordings, seeds and settings replayed by the amd64 programs and by those of the i386 package: how far do poses and
maps differ? A recorded live run in a room whose boxes come and go, and the real log `intel` where the data are there. Writes its
section of docs/results/service.md. As root.
usage: architectures.py [--quick] [--seed N] [--out FILE]    --quick: 30 s of the room alone"""
import math, pathlib, sys, time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "bench"))
import project
from live_run import LiveRun, replay, replay_of
from on_intel import KNOWN_START, missing_data, read_poses, recording
from project import ROOT

OUT = ROOT / "build/bench-i386"
TITLE = "The same results in 32 bits"
MOST_MEDIAN_M, MOST_P99_M, MOST_CELLS = 0.001, 0.01, 0.001


def cells(picture):
    """Of a binary PGM as the programs write it: its bytes."""
    data = picture.read_bytes()
    fields, at = [], 0
    while len(fields) < 4:
        end = data.index(b"\n", at)
        line = data[at:end].split(b"#")[0]
        fields, at = fields + line.split(), end + 1
    if fields[0] != b"P5" or len(data) - at != int(fields[1]) * int(fields[2]):
        raise SystemExit("%s: no map of one byte a cell" % picture)
    return data[at:]


def quantile(values, share):
    return sorted(values)[min(len(values) - 1, int(share * len(values)))]


def compared(ours, theirs):
    """What differs between the folders of two replays."""
    poses, others = read_poses(ours / "trajectory.tum"), read_poses(theirs / "trajectory.tum")
    if not poses or [pose[0] for pose in poses] != [pose[0] for pose in others]:
        raise SystemExit("%s and %s have not the same scans" % (ours, theirs))
    off_m = [math.hypot(a[1] - b[1], a[2] - b[2]) for a, b in zip(poses, others)]
    off_deg = [abs(math.degrees(math.remainder(a[3] - b[3], 2 * math.pi))) for a, b in zip(poses, others)]
    one, other = cells(ours / "map.pgm"), cells(theirs / "map.pgm")
    revisions = [len((folder / "changes.jsonl").read_text().splitlines()) for folder in (ours, theirs)]
    known = sum(cell != 205 for cell in one)  # 205: what map_server writes for unknown
    return {"scans": len(poses), "median_m": quantile(off_m, 0.5), "p99_m": quantile(off_m, 0.99), "most_m": max(off_m), "most_deg": max(off_deg),
            "same": sum(m == 0 for m in off_m), "known": known, "cells": sum(a != b for a, b in zip(one, other)) + abs(len(one) - len(other)), "revisions": revisions}


def is_met(found):
    return found["median_m"] <= MOST_MEDIAN_M and found["p99_m"] <= MOST_P99_M and found["cells"] <= MOST_CELLS * found["known"]


def on_the_room(seed, seconds):
    with LiveRun(OUT / "room", "amd64", seed) as live:
        time.sleep(seconds)
    for architecture in ("amd64", "i386"):
        replay_of(live, architecture, OUT / "room" / architecture, "--seed", seed)
    return compared(OUT / "room/i386", OUT / "room/amd64")


def on_intel(seed):
    bytes_of_intel = recording()
    project.unpacked("maps/ref_intel.pgm", OUT / "data")
    first_map = project.unpacked("maps/ref_intel.yaml", OUT / "data")
    for architecture in ("amd64", "i386"):
        replay(architecture, bytes_of_intel, first_map, OUT / "intel" / architecture, "--config", ROOT / "config/pioneer.yaml", "--seed", seed,
               "--set", "laser.mount.x_m=0", "--initial-pose", KNOWN_START)
    return compared(OUT / "intel/i386", OUT / "intel/amd64")


def section(found, seed):
    lines = ["The same bytes, seed (%d) and settings, replayed by the amd64 programs and by those of the i386 package. The C library computes" % seed,
             "angles and exponentials with other last digits there; the sums of a scan's weights are whole numbers. Asked for: half of all poses within",
             "%g mm, 99 %% within %g mm, and at most %g %% of the known cells different." % (1000 * MOST_MEDIAN_M, 1000 * MOST_P99_M, 100 * MOST_CELLS), "",
             "| recording | scans | poses that are equal | median | 99 % | farthest | farthest turn | revisions, i386 and amd64 | cells that differ | |",
             "|---|---|---|---|---|---|---|---|---|---|"]
    for name, f in found:
        lines.append("| %s | %d | %d | %.3g mm | %.3g mm | %.3g mm | %.2g° | %d, %d | %d of %d | %s |" %
                     (name, f["scans"], f["same"], 1000 * f["median_m"], 1000 * f["p99_m"], 1000 * f["most_m"], f["most_deg"], *f["revisions"], f["cells"], f["known"],
                      "met" if is_met(f) else "**missed**"))
    return lines


def measure(seed, quick):
    drive_s = 30 if quick else 180
    found = [("%d s in a room whose boxes come and go" % drive_s, on_the_room(seed, drive_s))]
    if not quick and not missing_data():
        found.append(("`intel`, 45 minutes of a real building, mapping on", on_intel(seed)))
    return section(found, seed), all(is_met(f) for _, f in found)


if __name__ == "__main__":
    project.measure_a_section(__doc__, "./dev bench i386", TITLE, measure)
