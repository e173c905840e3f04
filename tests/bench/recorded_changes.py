#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Real scans in maps that were made out of date, with the wheels of the log and with poor ones: is the map mended?

    tests/bench/recorded_changes.py OUT [--tool FILE] [--seeds N] [--only TEXT] [--set KEY=VALUE]...

Writes OUT/recorded.csv, a row a run, which tests/bench/paired.py compares with that of another program. The logs are
`intel` and `wean3`; of each map things are erased and boxes added, drawn by the seed (../shared/tools). Kinds:

  own     the wheels of the log, the start is given
  poor    wheels made of the reference: 2 % too far, 0.3 degrees a metre, stamped 120 ms late
  worse   the wheels of the log with the same errors on top
  global  the wheels of the log, the start is not given
"""
import bisect
import json
import math
import pathlib
import sys

import recorded
from recorded import AHEAD_M, DATA, TOOLS, run, unpacked

STARTS = {"intel": "9.442,-3.389,-156.2", "wean3": "44.508,15.702,-91.93"}
KINDS = ["own", "poor", "worse", "global"]
SCALE = 1.02
DRIFT_RAD_PER_M = math.radians(0.3)
LATE_S = 0.12
ROBOT_WORDS = slice(-6, -3)  # of a FLASER line: … laser x y theta, robot x y theta, stamp, host, logger's time


def after(pose, motion):
    c, s = math.cos(pose[2]), math.sin(pose[2])
    return (pose[0] + c * motion[0] - s * motion[1], pose[1] + s * motion[0] + c * motion[1], pose[2] + motion[2])


def motion_between(a, b):
    dx, dy, c, s = b[0] - a[0], b[1] - a[1], math.cos(a[2]), math.sin(a[2])
    return (c * dx + s * dy, -s * dx + c * dy, math.remainder(b[2] - a[2], 2.0 * math.pi))


def counted_poorly(poses):
    """The poses that wheels with the errors would count, from the first on."""
    made = [poses[0]]
    for last, now in zip(poses, poses[1:]):
        x, y, turn = motion_between(last, now)
        made.append(after(made[-1], (SCALE * x, SCALE * y, turn + DRIFT_RAD_PER_M * math.hypot(x, y))))
    return made


def late(times, poses):
    """What a stamp shows that is put on LATE_S after the wheels were read."""
    shown = []
    for time in times:
        i = max(0, min(bisect.bisect(times, time - LATE_S) - 1, len(times) - 2))
        passed = times[i + 1] - times[i]
        share = min(1.0, max(0.0, (time - LATE_S - times[i]) / passed)) if passed > 0.0 else 0.0
        shown.append(after(poses[i], [share * part for part in motion_between(poses[i], poses[i + 1])]))
    return shown


def reference_of(log):
    """{stamp: pose of the robot} of the reference, which is of the laser."""
    back = (-AHEAD_M[log], 0.0, 0.0)
    return {round(row[0], 3): after(row[1:4], back) for row in recorded.reference_of(log, OUT / "data")}


def with_poor_wheels(log, of_reference):
    """The scans of the log with other poses; its ODOM lines are left out, for scans carry poses."""
    target = OUT / "data" / ("%s-%s.log" % (log, "poor" if of_reference else "worse"))
    lines = unpacked("logs/%s.log" % log, OUT / "data").read_text().splitlines()
    scans = [line.split() for line in lines if line.startswith("FLASER")]
    if of_reference:
        reference = reference_of(log)
        scans = [words for words in scans if round(float(words[-3]), 3) in reference]
        poses = [reference[round(float(words[-3]), 3)] for words in scans]
    else:
        poses = [tuple(float(word) for word in words[ROBOT_WORDS]) for words in scans]
    shown = late([float(words[-3]) for words in scans], counted_poorly(poses))
    with open(target, "w", encoding="utf-8") as out:
        for words, pose in zip(scans, shown):
            laser = after(pose, (AHEAD_M[log], 0.0, 0.0))
            numbers = ["%.6f" % part for part in (*laser, *pose)]
            out.write(" ".join([*words[:-9], *numbers, *words[-3:]]) + "\n")
    return target


def recording(tool, log, kind):
    name = log + ("-" + kind if kind in ("poor", "worse") else "")
    target = OUT / "data" / (name + ".pcapng")
    if not target.exists():
        made = with_poor_wheels(log, kind == "poor") if kind in ("poor", "worse") else unpacked("logs/%s.log" % log, OUT / "data")
        run(tool, "import", "carmen", made, target)
    return target


def changed_map(log, seed):
    unpacked("maps/ref_%s.pgm" % log, OUT / "data")
    true_map = unpacked("maps/ref_%s.yaml" % log, OUT / "data")
    was = OUT / "data" / ("%s-was-%d.yaml" % (log, seed))
    if not was.exists():
        run(sys.executable, TOOLS / "make_changed_map.py", true_map, DATA / ("reference/%s.gt.txt.xz" % log), was, "--seed", seed)
    return true_map, was


def found(score):
    """Share of the changes of which at least half is right."""
    pairs = [score[key].split("/") for key in ("found_removed", "found_added") if key in score]
    return sum(int(some) for some, _ in pairs) / max(1, sum(int(of) for _, of in pairs))


def run_one(tool, log, kind, seed, settings):
    name = "%s-%s-seed%d" % (log, kind, seed)
    true_map, was = changed_map(log, seed)
    start = [] if kind == "global" else ["--initial-pose", STARTS[log]]
    folder = OUT / "runs" / name
    pose = recorded.replayed(tool, log, recording(tool, log, kind), was, folder, seed, settings, *start)
    report = json.loads((folder / "report.json").read_text())
    score = json.loads(run(sys.executable, TOOLS / "score_change.py", true_map, was, folder / "map.yaml", was.with_suffix(".changes.json")))
    gate = report["write_gate"]
    row = {"run": name, "recall": round(found(score), 3), "skill": score["skill"], "walls_kept": score["kept"],
           "ghost_m2": score["ghost_m2"], "error_median_m": pose["median_m"], "error_p95_m": pose["p95_m"],
           "off_share": pose["lost"], "revisions": report["revisions_total"], "shut_share": round(gate["shut_s"] / gate["observed_s"], 4),
           "shut_by_reason": " ".join("%s:%.0f" % item for item in sorted(gate["shut_by_reason_s"].items()))}
    print("%(run)-22s found %(recall)-5s skill %(skill)-7s kept %(walls_kept)-8s ghosts %(ghost_m2)-6s median %(error_median_m)-7s"
          " off %(off_share)-6s shut %(shut_share)-6s %(shut_by_reason)s" % row, flush=True)
    return row


def main():
    global OUT
    given = recorded.options(__doc__, seeds=5).parse_args()
    OUT = pathlib.Path(given.out).resolve()
    rows = []
    for log in STARTS:
        for kind in KINDS:
            for seed in range(1, given.seeds + 1):
                if given.only in "%s-%s-seed%d" % (log, kind, seed):
                    rows.append(run_one(given.tool, log, kind, seed, given.set))
    if not rows:
        raise SystemExit("recorded_changes: no run has %r in its name" % given.only)
    recorded.write_table(OUT / "recorded.csv", rows)


if __name__ == "__main__":
    main()
