#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""What the i386 package's daemon would cost on the netbook's Atom, behind a simulated robot in real time: 500 particles, 181 beams,
recording on. callgrind counts the instructions of two live runs of different length; their difference is what a second costs.
A third run tells the peak of memory, and what the kernel adds. Two more have one processor for all of its threads and tell how soon
scans are answered. Meanwhile its pipeline runs for seven hours of virtual time and tells whether it grows. Writes its section of
docs/results/service.md. As root, on a machine that has a quarter of a processor to spare.
usage: atom.py [--quick] [--seed N] [--out FILE]    --quick: 20 s in place of 60 and of 240, half an hour in place of seven"""
import concurrent.futures, csv, json, pathlib, re, subprocess, sys, time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "bench"))
import one_core, project
from live_run import LiveRun, program
from measuring import row, table_lines
from project import ROOT

OUT = ROOT / "build/bench-atom"
TITLE = "Load on the Atom"
ATOM_PER_S = 800e6  # instructions an N270 does in a second of usual code: 1.6 GHz at 0.5 a cycle
MOST_SHARE, MOST_MB = 0.10, 28
SCANS_PER_S = 9.4   # what 38400 baud carry
LEAST_SCANS_PER_S = 2.0
SLOWER = 8          # an N270's core than this machine's, in the same i386 code: 6 to 13 by published benchmarks
VIRTUAL_H = 7
STARTED_S = 10      # of a run: reading the map and finding the pose are no load that lasts
CALLGRIND = ("valgrind", "--tool=callgrind", "--callgrind-out-file=/dev/null")


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


def hours_of_the_pipeline(seed, hours):
    """What daemon threads, store, recording and files hold in memory over hours of virtual time: the figure that is judged, of the
    last hour against the fourth, and [(hours, heap in MB, resident MB)] on the way."""
    out = OUT / "hours"
    command = ["nice", "-n", 10, "taskset", "-c", one_core.others()] + program("i386", "deltamap") + ["experiment", "endurance", "--only", "pipeline", "--minutes", 60 * hours, "--seed", seed, "--jobs", 1, "--scans", "--out", out]
    done = subprocess.run([str(part) for part in command], cwd=ROOT, capture_output=True, text=True)
    tables = list(out.glob("scans/pipeline*.csv"))
    if len(tables) != 1:
        raise SystemExit("atom: the pipeline told nothing of its memory:\n%s" % done.stderr[-2000:])
    figures = {figure["name"]: figure for figure in json.loads((out / "summary.json").read_text())["figures"]}
    growth = next(figure for name, figure in figures.items() if "heap_growth_mb" in name)
    with open(tables[0]) as table:
        return growth, [(float(line["t_s"]) / 3600, float(line["heap_mb"]), float(line["resident_mb"])) for line in csv.DictReader(table)]


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


def memory_row(seed, hours):
    growth, course = hours_of_the_pipeline(seed, hours)
    told = "heap %s MB after %s h" % (", ".join("%.2f" % heap for _, heap, _ in course), ", ".join("%.1f" % h for h, _, _ in course))
    told += "; resident %.1f MB after the first of these and %.1f MB at the end" % (course[0][2], course[-1][2])
    if growth["value"] is None:
        return row("%g virtual hours of the pipeline: memory" % hours, told)
    return row("%g virtual hours of the pipeline: growth of the heap from the fourth hour to the last" % hours, "%.2f MB; %s" % (growth["value"], told),
               "≤ %g MB" % growth["target"]["most"], growth["met"])


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
            "more with a process on that processor that computes without a pause, at the daemon's own priority: as if a map update never ended. Load: processes that",
            "wanted to run in the last minute of it, on all processors of this machine, these included.", "",
            "The memory: the daemon's own pipeline, with threads, store, recording and files, at 2 scans a second of virtual time in `endurance.yaml`, where containers",
            "are moved, doors open and people pass; the simulator's memory is in it. The hall is seen whole after four hours, and until then what is kept of it grows.",
            ""] + table_lines(made)


def of_a_drive(seed, quick):
    seconds, latency_s, hours = (20, 20, 0.5) if quick else (60, 240, VIRTUAL_H)
    with concurrent.futures.ThreadPoolExecutor(1) as pool:  # on the processors that the daemon of the answers has not
        memory = pool.submit(memory_row, seed, hours)
        made = rows(measure(seed, seconds)) + latency_rows(seed, latency_s) + [memory.result()]
    return section(made, seed, seconds, latency_s), all(r["met"] is not False for r in made)


if __name__ == "__main__":
    project.measure_a_section(__doc__, "./dev bench atom", TITLE, of_a_drive)
