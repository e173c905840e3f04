#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""What the i386 package's daemon would cost on the netbook's Atom, behind a simulated robot in real time: 500 particles, 181 beams,
recording on. callgrind counts the instructions of two live runs of different length; their difference is what a second costs.
A third run tells the peak of memory, and what the kernel adds. Two more have one processor for all of its threads and tell how soon
scans are answered. Writes its section of docs/results/service.md. As root, on a machine that has a quarter of a processor to spare.
usage: atom.py [--quick] [--seed N] [--out FILE]    --quick: 20 s in place of 60 and of 150"""
import json, pathlib, re, sys, time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "bench"))
import one_core, project
from live_run import LiveRun
from measuring import row, table_lines
from project import ROOT

OUT = ROOT / "build/bench-atom"
TITLE = "Load on the Atom"
ATOM_PER_S = 800e6  # instructions an N270 does in a second of usual code: 1.6 GHz at 0.5 a cycle
MOST_SHARE, MOST_MB = 0.10, 28
SCANS_PER_S = 9.4   # what 38400 baud carry
LEAST_SCANS_PER_S = 2.0
SLOWER = 8          # an N270's core than this machine's, in the same i386 code: 6 to 13 by published benchmarks
STARTED_S = 10      # of a run: reading the map and finding the pose are no load that lasts
CALLGRIND = (*one_core.BEFORE_OTHERS, "valgrind", "--tool=callgrind", "--callgrind-out-file=/dev/null")


def counted(seed, seconds):
    """Instructions of a live run, and the scans that it localized."""
    with LiveRun(OUT / "counted", "i386", seed, CALLGRIND) as run:
        time.sleep(seconds)
        localized = json.loads(run.ctl("--json", "status").stdout)["localized"]
    found = re.search(r"Collected : (\d+)", run.log.read_text())
    if not found:
        raise SystemExit("callgrind counted nothing:\n%s" % run.log.read_text()[-2000:])
    return int(found.group(1)), localized


def as_it_is(seed, seconds):
    """Processor time a second of each thread, kernel included, and the peak of memory."""
    with LiveRun(OUT / "live", "i386", seed) as run:
        time.sleep(STARTED_S)
        before_s, began = run.processor_s(), time.monotonic()
        time.sleep(seconds)
        took_s, after_s = time.monotonic() - began, run.processor_s()
        return {thread: (after_s[thread] - before_s.get(thread, 0)) / took_s for thread in after_s}, run.peak_mb()


def measure(seed, seconds):
    share, peak_mb = as_it_is(seed, seconds)
    begin, whole = counted(seed, STARTED_S), counted(seed, STARTED_S + seconds)
    scans_per_s = (whole[1] - begin[1]) / seconds
    if scans_per_s < LEAST_SCANS_PER_S:
        raise SystemExit("atom: %.1f scans a second were localized under callgrind: this machine is too busy" % scans_per_s)
    per_s = (whole[0] - begin[0]) / seconds * max(1, SCANS_PER_S / scans_per_s)
    return {"scans_per_s": scans_per_s, "per_s": per_s, "share": share, "peak_mb": peak_mb}


def latency_row(name, f):
    told = "%.1f ms (half within %.1f, 99 %% within %.1f, slowest %.1f); %d scans, %d dropped, %d map updates; load %.1f" % (
        f["p999"], f["p50"], f["p99"], f["max"], f["scans"], f["drops"], f["updates"], f["load"])
    return row("99.9 %% of scans answered, one processor for all threads, %s" % name, told, "≤ %d ms" % one_core.MOST_MS, f["p999"] <= one_core.MOST_MS)


def latency_rows(seed, seconds):
    driving = one_core.answered(OUT / "latency", seed, seconds, False)
    pressed = one_core.answered(OUT / "pressed", seed, seconds, True)
    on_atom_ms = SLOWER * driving["p999"]
    return [latency_row("as it drives about", driving), latency_row("beside a process that computes without a pause", pressed),
            row("the first of both, times %d, as an Atom's core is slower" % SLOWER, "%.1f ms" % on_atom_ms, "≤ %d ms" % one_core.MOST_MS, on_atom_ms <= one_core.MOST_MS)]


def rows(f):
    threads = ", ".join("%s %.2f" % (thread, 100 * share) for thread, share in sorted(f["share"].items(), key=lambda item: -item[1]) if share > 5e-5)
    return [row("scans localized a second, under callgrind", "%.1f of %.1f" % (f["scans_per_s"], SCANS_PER_S)),
            row("instructions a second of the whole daemon", "%.1f million, %.1f %% of an Atom N270" % (f["per_s"] / 1e6, 100 * f["per_s"] / ATOM_PER_S),
                "≤ %.0f million" % (MOST_SHARE * ATOM_PER_S / 1e6), f["per_s"] <= MOST_SHARE * ATOM_PER_S),
            row("processor time of its threads here, kernel included", "%.2f %% of one processor: %s" % (100 * sum(f["share"].values()), threads)),
            row("peak of resident memory", "%.1f MB" % f["peak_mb"], "≤ %d MB" % MOST_MB, f["peak_mb"] <= MOST_MB)]


def section(made, seed, seconds, latency_s):
    return ["The daemon of the i386 package, live for %d s (seed %d) behind a simulated robot that drives about in a room whose boxes come and go: 500 particles," % (seconds, seed),
            "181 beams at 38400 baud, store and recording on. callgrind counts the instructions of all its threads, without the kernel's. An Atom N270 is taken for",
            "%.0f million a second: 1.6 GHz at one in two cycles; divisions and roots, which take it thirty to sixty cycles, count as one. Under callgrind this machine" % (ATOM_PER_S / 1e6),
            "may localize only a part of the scans; all that the daemon does is then multiplied by what is missing, also what no scan costs: an upper bound.", "",
            "The answers: the same daemon for %d s with all its threads on one processor, from a scan's last byte to its pose; the simulator has the others. Once" % latency_s,
            "more with a process on that processor that computes without a pause, at the daemon's own priority: as if a map update never ended. Both go before what else",
            "this machine does (nice -15). Load: processes that wanted to run in the last minute of it, on all processors of this machine, these included.", ""] + table_lines(made)


def of_a_drive(seed, quick):
    seconds, latency_s = (20, 20) if quick else (60, 150)
    made = rows(measure(seed, seconds)) + latency_rows(seed, latency_s)
    return section(made, seed, seconds, latency_s), all(r["met"] is not False for r in made)


if __name__ == "__main__":
    project.measure_a_section(__doc__, "./dev bench atom", TITLE, of_a_drive)
