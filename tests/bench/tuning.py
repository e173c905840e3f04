#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""What `deltamap sweep` costs beside a shell loop of `deltamap replay`, and the worked example of docs/tuning.md.

    tests/bench/tuning.py OUT [--tool FILE] [--example | --loop] [--rounds N]

  --example  writes the section "A worked example" of docs/tuning.md: the commands, and what they print
  --loop     writes the section "A sweep against a shell loop" of docs/results/replay.md: the same 60 replays of `intel`,
             `aces` and `wean3` by `sweep --jobs 2` and by `xargs -P 2`, in turn; wall time and CPU time of both
"""
import argparse
import datetime
import math
import os
import pathlib
import resource
import shlex
import subprocess
import sys
import time

import recorded
import recorded_logs
from project import ROOT, provenance, run, unpacked, write_section
from recorded import AHEAD_M

DRIVES = ["intel", "aces", "wean3"]
BEAMS = [30, 68, 105, 143, 180]
SEEDS = 4
MOST_SHARE = 0.7


def start_of(log):
    _, x, y, theta = recorded.reference_of(log, OUT / "data")[0]
    return "%.3f,%.3f,%.1f" % (x - AHEAD_M[log] * math.cos(theta), y - AHEAD_M[log] * math.sin(theta), math.degrees(theta))


def prepare(tool):
    """Recordings, maps and references below OUT/data; {log: (recording, map)}."""
    files = {}
    for log in DRIVES:
        recording = OUT / "data" / (log + ".pcapng")
        if not recording.exists():
            run(tool, "import", "carmen", unpacked("logs/%s.log" % log, OUT / "data"), recording)
        unpacked("reference/%s.gt.txt" % log, OUT / "data")
        files[log] = (recording, recorded_logs.map_of(tool, log))
    return files


def sweep_words(files):
    words = [str(files[log][0]) for log in DRIVES]
    for log in DRIVES:
        words += ["--map", str(files[log][1]), "--reference", str(OUT / "data/reference" / (log + ".gt.txt")), "--initial-pose=" + start_of(log)]
    return words + ["--of-laser", "--set", "3:laser.mount.x_m=%g" % AHEAD_M["wean3"]]


def timed(command, **more):
    """Wall and CPU seconds of the command and its children."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    began = time.monotonic()
    subprocess.run([str(word) for word in command], check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, **more)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return time.monotonic() - began, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def measure_loop(tool, rounds):
    files = prepare(tool)
    lines = []
    for seed in range(1, SEEDS + 1):
        for beams in BEAMS:
            for log in DRIVES:
                words = ["replay", files[log][0], "--map", files[log][1], "--initial-pose=" + start_of(log), "--seed", seed,
                         "--set", "laser.mount.x_m=%g" % AHEAD_M[log], "--set", "localization.beams=%d" % beams,
                         "--out", OUT / "loop" / ("%s-%d-%d" % (log, beams, seed))]
                lines.append(" ".join(shlex.quote(str(word)) for word in words))
    (OUT / "loop").mkdir(exist_ok=True)
    (OUT / "loop.txt").write_text("\n".join(lines) + "\n")
    rows = []
    for _ in range(rounds):
        loop = timed(["xargs", "-a", OUT / "loop.txt", "-P", "2", "-L", "1", tool])
        sweep = timed([tool, "sweep", *sweep_words(files), "--param", "localization.beams=30:180:5", "--seeds", SEEDS, "--jobs", 2,
                       "--out", OUT / "sweep", "--anew"])
        rows.append((loop, sweep))
        print("xargs %.1f s, %.1f s CPU; sweep %.1f s, %.1f s CPU" % (*loop, *sweep), flush=True)
    walls = sorted(sweep[0] / loop[0] for loop, sweep in rows)
    cpus = sorted(sweep[1] / loop[1] for loop, sweep in rows)
    share = walls[len(walls) // 2]
    table = ["Written by `tests/bench/tuning.py --loop` (%s, %s; load of the machine at the end: %.1f)." % (provenance(), datetime.date.today(), os.getloadavg()[0]), "",
             "5 values of `localization.beams`, 3 recordings (`intel`, `aces`, `wean3`), 4 seeds, two at a time; the map is updated, as delivered.",
             "The time holds what else the machine does, and what a replay waits for the disk; the CPU does not: on a busy machine go by that.", "",
             "| round | `xargs -P 2`, s | its CPU, s | `sweep --jobs 2`, s | its CPU, s | share of the time | of the CPU |", "|---|---|---|---|---|---|---|"]
    for i, (loop, sweep) in enumerate(rows):
        table.append("| %d | %.1f | %.1f | %.1f | %.1f | %.2f | %.2f |" % (i + 1, *loop, *sweep, sweep[0] / loop[0], sweep[1] / loop[1]))
    table += ["", "Median: %.2f of the time, %.2f of the CPU; asked for: at most %.1f of the time: %s." % (
        share, cpus[len(cpus) // 2], MOST_SHARE, "met" if share <= MOST_SHARE else "**missed**")]
    write_section(ROOT / "docs/results/replay.md", "A sweep against a shell loop", table)
    return share <= MOST_SHARE


def write_example(tool):
    files = prepare(tool)
    here = OUT / "example"
    here.mkdir(exist_ok=True)
    for name in ("intel.pcapng", "map.yaml", "truth.txt"):
        (here / name).unlink(missing_ok=True)
    (here / "intel.pcapng").symlink_to(files["intel"][0])
    (here / "map.yaml").symlink_to(files["intel"][1])
    (here / files["intel"][1].with_suffix(".pgm").name).unlink(missing_ok=True)
    (here / files["intel"][1].with_suffix(".pgm").name).symlink_to(files["intel"][1].with_suffix(".pgm"))
    (here / "truth.txt").symlink_to(OUT / "data/reference/intel.gt.txt")
    common = "intel.pcapng --map map.yaml --reference truth.txt --of-laser --initial-pose=" + start_of("intel")
    commands = [
        ("How good is it as delivered, and do the seeds matter?", "score %s" % common),
        ("How many beams are needed?", "sweep %s --param localization.beams=15:120:4:log --seeds 5 --anew" % common),
        ("Three keys at once, 60 runs:",
         "sweep %s --param localization.motion.turn_per_turn=0.02:0.5:2:log --param localization.field.hit_deviation_m=0.03:0.3:2:log"
         " --param localization.field.random_share=0.02:0.2:2 --optimize 60 --anew" % common)]
    lines = ["Written by `tests/bench/tuning.py --example` (%s, %s): `intel`, a log of 514 m with poor wheels, on the map of its building." % (
        provenance(), datetime.date.today()), ""]
    for what, command in commands:
        done = subprocess.run([str(tool), *command.split()], cwd=here, text=True, capture_output=True, check=True)
        lines += [what, "", "```", "$ deltamap " + command, done.stdout.rstrip("\n"), "```", ""]
    write_section(ROOT / "docs/tuning.md", "A worked example", lines)
    return True


def main():
    global OUT
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("--tool", default=ROOT / "build/release/bin/deltamap")
    parser.add_argument("--example", action="store_true")
    parser.add_argument("--loop", action="store_true")
    parser.add_argument("--rounds", type=int, default=3)
    given = parser.parse_args()
    OUT = recorded_logs.OUT = given.out.resolve()
    (OUT / "data").mkdir(parents=True, exist_ok=True)
    met = True
    if given.loop or not given.example:
        met = measure_loop(given.tool, given.rounds)
    if given.example or not given.loop:
        met = write_example(given.tool) and met
    sys.exit(0 if met else 1)


if __name__ == "__main__":
    main()
