#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The same recordings, seeds and settings replayed by the amd64 programs and by those of the i386 package: how far do poses and
maps differ? A recorded live run in a room whose boxes come and go, and the real log `intel` where the data are there. On `intel` also
amd64 with itself, its start the width of an atom aside: what the smallest other input makes of the same program; and both with the
functions of same_digits.cpp in place of the C library's: then nothing may differ. Writes its section of docs/results/service.md. As root.
usage: architectures.py [--quick] [--seed N] [--out FILE]    --quick: 30 s of the room alone"""
import csv, filecmp, json, math, pathlib, subprocess, sys, time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "bench"))
import project
from live_run import LiveRun, replay, replay_of
from on_intel import KNOWN_START, errors, missing_data, read_poses, recording
from project import DATA, ROOT

OUT = ROOT / "build/bench-i386"
TITLE = "The same results in 32 bits"
MOST_MEDIAN_M, MOST_P99_M, MOST_CELLS = 0.001, 0.01, 0.001
DISTURBED, STEP_M = 6, 1e-10  # replays of amd64 with another start, each so much farther aside
MOST_OF_OWN = 1.5   # times the farthest that amd64 gets from itself so
REPEATED = ("trajectory.tum", "localization.csv", "changes.jsonl", "map.yaml", "map.pgm")
MOST_ERROR_M = 0.005  # beyond the mean errors of amd64 against the reference


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


def parting(ours, theirs):
    """The first scan whose row differs in any of its nine digits, the column, and by how much; nothing where none does."""
    with open(ours / "localization.csv") as one, open(theirs / "localization.csv") as other:
        for scan, (a, b) in enumerate(zip(csv.DictReader(one), csv.DictReader(other))):
            for name in a:
                if a[name] != b[name]:
                    return scan, name, a[name], b[name]
    return None


def mean_error_m(folder):
    """Against the reference of `intel`."""
    off_m = [m for _, m, _ in errors(read_poses(folder / "trajectory.tum"), read_poses(DATA / "reference/intel.gt.txt.xz"))]
    return sum(off_m) / len(off_m)


def compared(ours, theirs):
    """What differs between the folders of two replays."""
    poses, others = read_poses(ours / "trajectory.tum"), read_poses(theirs / "trajectory.tum")
    if not poses or [pose[0] for pose in poses] != [pose[0] for pose in others]:
        raise SystemExit("%s and %s have not the same scans" % (ours, theirs))
    off_m = [math.hypot(a[1] - b[1], a[2] - b[2]) for a, b in zip(poses, others)]
    off_deg = [abs(math.degrees(math.remainder(a[3] - b[3], 2 * math.pi))) for a, b in zip(poses, others)]
    one, other = cells(ours / "map.pgm"), cells(theirs / "map.pgm")
    revisions = [sum(json.loads(line)["accepted"] for line in (folder / "changes.jsonl").read_text().splitlines()) for folder in (ours, theirs)]
    known = sum(cell != 205 for cell in one)  # 205: what map_server writes for unknown
    return {"scans": len(poses), "median_m": quantile(off_m, 0.5), "p99_m": quantile(off_m, 0.99), "most_m": max(off_m), "most_deg": max(off_deg),
            "same": sum(m == 0 for m in off_m), "known": known, "cells": sum(a != b for a, b in zip(one, other)) + abs(len(one) - len(other)), "revisions": revisions}


def same_digits(architecture):
    """What a program runs under to have the same functions of angles and exponentials on both architectures."""
    library = OUT / ("same_digits-%s.so" % architecture)
    build = ["g++", "-O2", "-std=c++20", "-fPIC", "-shared", "-fno-builtin", "-ffp-contract=off", "-o", library, ROOT / "tests/target/same_digits.cpp"]
    build = build if architecture == "amd64" else [ROOT / "packaging/i386.sh", *build, "-msse2", "-mfpmath=sse"]
    subprocess.run([str(part) for part in build], cwd=ROOT, check=True)
    return "env", "LD_PRELOAD=%s" % library


def is_met(found):
    return found["median_m"] <= MOST_MEDIAN_M and found["p99_m"] <= MOST_P99_M and found["cells"] <= MOST_CELLS * found["known"]


def is_as_near_as_itself(found, own):
    """No farther from amd64 than amd64 is from itself, and as right."""
    worst = {what: MOST_OF_OWN * max(one[what] for one in own) for what in ("median_m", "p99_m", "cells")}
    errors_m = [found["error_of_amd64_m"]] + [one["error_m"] for one in own]
    return all(found[what] <= worst[what] for what in worst) and min(errors_m) - MOST_ERROR_M <= found["error_m"] <= max(errors_m) + MOST_ERROR_M


def on_the_room(seed, seconds):
    with LiveRun(OUT / "room", "amd64", seed) as live:
        time.sleep(seconds)
    for architecture in ("amd64", "i386"):
        replay_of(live, architecture, OUT / "room" / architecture, "--seed", seed)
    return compared(OUT / "room/i386", OUT / "room/amd64")


def starts():
    """The known start, then others so near that no instrument tells them apart."""
    x, rest = KNOWN_START.split(",", 1)
    return ["%.13g,%s" % (float(x) + i * STEP_M, rest) for i in range(DISTURBED + 1)]


def on_intel(seed):
    """With mapping off and on: i386 against amd64, amd64 against itself; then both with the same functions."""
    bytes_of_intel, folder = recording(), OUT / "intel"
    project.unpacked("maps/ref_intel.pgm", OUT / "data")
    first_map = project.unpacked("maps/ref_intel.yaml", OUT / "data")

    def into(name, architecture, start, *options, under=()):
        replay(architecture, bytes_of_intel, first_map, folder / name, "--config", ROOT / "config/pioneer.yaml", "--seed", seed,
               "--set", "laser.mount.x_m=0", "--initial-pose", start, *options, under=under)
        return folder / name

    def held_against_itself(mapping):
        option = ("--set", "mapping.enabled=" + mapping)
        amd64, *others = [into("amd64-%s-%d" % (mapping, i), "amd64", start, *option) for i, start in enumerate(starts())]
        i386 = into("i386-" + mapping, "i386", KNOWN_START, *option)
        found = {**compared(i386, amd64), "parting": parting(i386, amd64), "error_m": mean_error_m(i386), "error_of_amd64_m": mean_error_m(amd64)}
        return found, [{**compared(other, amd64), "error_m": mean_error_m(other)} for other in others]

    alike = [into("alike-" + architecture, architecture, KNOWN_START, under=same_digits(architecture)) for architecture in ("i386", "amd64")]
    differing = [name for name in REPEATED if not filecmp.cmp(alike[0] / name, alike[1] / name, shallow=False)]
    return {"off": held_against_itself("false"), "on": held_against_itself("true"), "alike": {**compared(*alike), "differing": differing}}


def told(name, f, verdict):
    return "| %s | %d | %d | %.3g mm | %.3g mm | %.3g mm | %.2g° | %d, %d | %d of %d | %s |" % (
        name, f["scans"], f["same"], 1000 * f["median_m"], 1000 * f["p99_m"], 1000 * f["most_m"], f["most_deg"], *f["revisions"], f["cells"], f["known"], verdict)


def in_mm(metres):
    return ", ".join("%.1f" % (1000 * m) for m in metres)


def of_intel(intel):
    """What the table cannot say."""
    (found, own), (still, still_own), differing = intel["on"], intel["off"], intel["alike"]["differing"]
    parts = "at scan %d, `%s` %s and %s" % found["parting"] if found["parting"] else "nowhere"
    same = "byte for byte the same on both" if not differing else "**not** the same on both (%s)" % ", ".join(differing)
    return ["", "`intel`: with the same functions of angles and exponentials (`tests/target/same_digits.cpp`) in place of the C library's, %s" % ", ".join("`%s`" % name for name in REPEATED),
            "are %s. So the last digits of the C library are all that can differ: no word size, no x87 arithmetic, no order of a table." % same,
            "They do not stay small. With mapping on i386 and amd64 first differ %s. A weight on the other side of a draw makes other particles, a beam on" % parts,
            "the other side of a threshold another vote, and each revision of the map changes what later scans are held against. amd64 does the same to itself: with its",
            "start %g m aside, two, and so on (the width of an atom), it makes %s revisions in place of %d, and its poses get as far apart (rows below)." % (
                STEP_M, ", ".join(str(one["revisions"][0]) for one in own), found["revisions"][1]),
            "Target there: i386 no farther from amd64 than %g times the farthest that amd64 gets from itself, and its mean error against the reference within %g mm of" % (MOST_OF_OWN, 1000 * MOST_ERROR_M),
            "those of amd64. Mean error, mapping on: i386 %s mm, amd64 %s mm; off: i386 %s mm, amd64 %s mm." % (
                in_mm([found["error_m"]]), in_mm([found["error_of_amd64_m"]] + [one["error_m"] for one in own]),
                in_mm([still["error_m"]]), in_mm([still["error_of_amd64_m"]] + [one["error_m"] for one in still_own]))]


def mark(holds):
    return "met" if holds else "**missed**"


def intel_rows(intel):
    """Of each: its line in the table, and whether it is as asked; None where nothing is asked."""
    made = [("the same functions on both, mapping on: all files equal", intel["alike"], not intel["alike"]["differing"])]
    for mapping in ("off", "on"):
        found, own = intel[mapping]
        made.append(("mapping " + mapping, found, is_as_near_as_itself(found, own)))
        made += [("mapping %s, amd64 against itself, %g m aside" % (mapping, STEP_M * (i + 1)), one, None) for i, one in enumerate(own)]
    return [(told("`intel`, " + name, f, "" if holds is None else mark(holds)), holds) for name, f, holds in made]


def section(seed, room, intel):
    lines = ["The same bytes, seed (%d) and settings, replayed by the amd64 programs and by those of the i386 package. The C library computes" % seed,
             "angles and exponentials with other last digits there; the sums of a scan's weights are whole numbers. Target in the simulated room: half of all poses within",
             "%g mm, 99 %% within %g mm, and at most %g %% of the known cells different." % (1000 * MOST_MEDIAN_M, 1000 * MOST_P99_M, 100 * MOST_CELLS)]
    if intel:
        lines += of_intel(intel)
    lines += ["", "| recording | scans | poses that are equal | median | 99 % | farthest | farthest turn | revisions, of this one and of amd64 | cells that differ | |",
              "|---|---|---|---|---|---|---|---|---|---|", told(room[0], room[1], mark(is_met(room[1])))]
    return lines + [line for line, _ in (intel_rows(intel) if intel else [])]


def measure(seed, quick):
    drive_s = 30 if quick else 180
    room = ("%d s in a room whose boxes come and go" % drive_s, on_the_room(seed, drive_s))
    intel = None if quick or missing_data() else on_intel(seed)
    asked = [is_met(room[1])] + [holds for _, holds in (intel_rows(intel) if intel else [])]
    return section(seed, room, intel), False not in asked


if __name__ == "__main__":
    project.measure_a_section(__doc__, "./dev bench i386", TITLE, measure)
