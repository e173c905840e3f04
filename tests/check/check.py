#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Measures every figure that the project promises and writes docs/results/check.md. Called by ./dev check.

  check.py [--quick] [--keep] [--only NAME]     --quick: one short demo, one seed; for trying the check itself
                                                --keep: do not play demos again that the last check has played"""
import argparse, concurrent.futures, filecmp, json, pathlib, shutil, sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from project import DATA, ROOT, provenance, run, settings_section, unpacked
from report_page import report_page

TOOLS = DATA.parent / "tools"
BIN = ROOT / "build/release/bin"
OUT = ROOT / "build/check"
INTEL = ["--set", "laser.mount.x_m=0", "--initial-pose", "9.442,-3.389,-156.2"]


class Table:
    """Rows of the result: what was measured, the figure, the promise, whether it holds."""

    def __init__(self):
        self.rows = []

    def add(self, on, name, figure, promise, holds):
        self.rows.append((on, name, figure, promise, holds))
        print("%-4s %-34s %-46s %-28s %s" % ("ok" if holds else "MISS", on, name, figure, promise), flush=True)

    def markdown(self):
        lines = ["| on | figure | measured | at least | |", "|---|---|---|---|---|"]
        return "\n".join(lines + ["| %s | %s | %s | %s | %s |" % (*row[:4], "✓" if row[4] else "**missed**") for row in self.rows])


def score(script, *arguments):
    return json.loads(run(sys.executable, TOOLS / script, *arguments))


def data_file(name):
    return unpacked(name, OUT / "data")


def map_file(name):
    data_file("maps/%s.pgm" % name)
    return data_file("maps/%s.yaml" % name)


def recording(log):
    target = OUT / (log + ".pcapng")
    if not target.exists():
        run(BIN / "deltamap", "import", "carmen", data_file("logs/%s.log" % log), target)
    return target


def replay(log, start_map, name, *options):
    folder = OUT / name
    run(BIN / "deltamap", "replay", recording(log), "--map", start_map, "--config", ROOT / "config/pioneer.yaml", "--out", folder, *options)
    return folder


def same_bytes(one, other, names):
    return [n for n in names if not filecmp.cmp(one / n, other / n, shallow=False)]


def check_intel(table):
    particles = ["--set", "localization.particles.min=500", "--set", "localization.particles.max=500", "--set", "localization.beams=0"]
    folder = replay("intel", map_file("ref_intel"), "intel", *INTEL, *particles)
    s = score("score_trajectory.py", folder / "trajectory.tum", DATA / "reference/intel.gt.txt.xz")
    on = "intel on ref_intel, 500 particles"
    table.add(on, "coverage", s["coverage"], "≥ 0.99", s["coverage"] >= 0.99)
    table.add(on, "median error, m", s["median_m"], "≤ 0.06", s["median_m"] <= 0.06)
    table.add(on, "95th percentile, m", s["p95_m"], "≤ 0.15", s["p95_m"] <= 0.15)
    table.add(on, "lost", s["lost"], "≤ 0.01", s["lost"] <= 0.01)
    report = json.loads((folder / "report.json").read_text())
    table.add(on, "CPU a scan, everything, ms", round(report["cpu"]["per_scan_ms"], 3), "≤ 1.5", report["cpu"]["per_scan_ms"] <= 1.5)
    peak = report["peak_resident_bytes"] / 2**20
    table.add(on, "peak resident memory, MB", round(peak, 1), "≤ 32", peak <= 32)
    again = replay("intel", map_file("ref_intel"), "intel-again", *INTEL, *particles)
    differing = same_bytes(folder, again, ["trajectory.tum", "map.pgm", "map.yaml", "changes.jsonl"])
    table.add("the same replay twice", "files that differ", ", ".join(differing) or "none", "none", not differing)


def check_changed(table, seeds):
    true_map = map_file("ref_intel")
    for seed in seeds:
        was = OUT / ("was-%d.yaml" % seed)
        run(sys.executable, TOOLS / "make_changed_map.py", true_map, DATA / "reference/intel.gt.txt.xz", was, "--seed", seed)
        folder = replay("intel", was, "changed-%d" % seed, *INTEL)
        s = score("score_change.py", true_map, was, folder / "map.yaml", was.with_suffix(".changes.json"))
        on = "intel, changed map, seed %d" % seed
        for kind in ("removed", "added"):
            found, of = map(int, s["found_" + kind].split("/"))
            table.add(on, "%s things found" % kind, s["found_" + kind], "≥ 9/10", found >= 0.9 * of)
        table.add(on, "skill", s["skill"], "≥ 0.65", s["skill"] >= 0.65)
        table.add(on, "cells kept that were right", s["kept"], "≥ 0.998", s["kept"] >= 0.998)
        table.add(on, "ghosts, m²", s["ghost_m2"], "≤ 0.4", s["ghost_m2"] <= 0.4)


def check_wean(table):
    # The reference is the laser's pose; the robot's centre lies 0.25 m behind it.
    was = map_file("wean5300")
    folder = replay("wean3", was, "wean3", "--set", "laser.mount.x_m=0.25", "--initial-pose", "44.508,15.702,-91.93")
    s = score("score_trajectory.py", folder / "trajectory.tum", DATA / "reference/wean3.gt.txt.xz", "--laser", "0.25")
    on = "wean3 on wean5300"
    table.add(on, "coverage", s["coverage"], "≥ 0.99", s["coverage"] >= 0.99)
    table.add(on, "median error, m", s["median_m"], "≤ 0.15", s["median_m"] <= 0.15)
    table.add(on, "lost", s["lost"], "≤ 0.01", s["lost"] <= 0.01)
    s = score("score_change.py", map_file("ref_wean3"), was, folder / "map.yaml")
    table.add(on, "F1 against ref_wean3, before → after", "%s → %s" % (s["f1_start"], s["f1_end"]), "rises", s["f1_end"] > s["f1_start"])
    table.add(on, "cells kept that were right", s["kept"], "≥ 0.998", s["kept"] >= 0.998)


def play_demo(seed, seconds):
    folder = OUT / ("demo-%d" % seed)
    if (folder / "run/report.json").exists():  # --keep: played before, scored anew
        (folder / "score.json").write_text(run(BIN / "deltamap", "score", "--truth", folder / "truth.jsonl", "--world",
            "config/scenarios/demo.yaml", "--trajectory", folder / "run/trajectory.tum", "--start-map", folder / "m0.yaml",
            "--map", folder / "run/map.yaml", "--json"))
        return folder
    run("tests/system/demo.sh", "--for", seconds, "--seed", seed, "--out", folder, "--pin", "0", "--page", "0")
    return folder


def check_demo(table, seeds, seconds):
    # All at once, every daemon on the same processor: a demo needs a twentieth of it.
    with concurrent.futures.ThreadPoolExecutor() as pool:
        folders = list(pool.map(lambda seed: play_demo(seed, seconds), seeds))
    all_found = all_eligible = 0
    for seed, folder in zip(seeds, folders):
        s = json.loads((folder / "score.json").read_text())
        on = "demo, %d s, seed %d" % (seconds, seed)
        found, eligible = s["changes"]["found"], s["changes"]["eligible"]
        table.add(on, "changes seen 10 s and found", "%d of %d" % (found, eligible), "≥ 80 %", found >= 0.8 * eligible)
        all_found, all_eligible = all_found + found, all_eligible + eligible
        error = s["localization"]
        table.add(on, "localization error, median, m", round(error["median_m"], 4), "≤ 0.06", error["median_m"] <= 0.06)
        table.add(on, "localization error, worst, m", round(error["max_m"], 3), "≤ 0.5", error["max_m"] <= 0.5)
        report = json.loads((folder / "run/report.json").read_text())
        p999 = report["latency_ms"]["p999"]
        table.add(on + ", one CPU, %d map updates" % len(report["revisions"]), "last byte → pose, 99.9 %, ms", round(p999, 2), "≤ 20", p999 <= 20)
        again = OUT / ("demo-%d-replayed" % seed)
        run(BIN / "deltamap", "replay", folder / "recording.pcapng", "--map", folder / "m0.yaml", "--config", "config/simulation.yaml",
            "--out", again, "--seed", seed)
        differing = same_bytes(folder / "run", again, ["trajectory.tum", "map.pgm", "changes.jsonl"])
        table.add(on, "its recording replayed: files that differ", ", ".join(differing) or "none", "none", not differing)
    table.add("all demos together", "changes seen 10 s and found", "%d of %d" % (all_found, all_eligible), "≥ 80 %",
              all_found >= 0.8 * all_eligible)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--keep", action="store_true")
    parser.add_argument("--only", choices=["intel", "changed", "wean", "demo"])
    arguments = parser.parse_args()
    if not DATA.exists():
        raise SystemExit("no real logs at %s: set DELTAMAP_DATA to check on them" % DATA)
    if not arguments.keep:
        shutil.rmtree(OUT, ignore_errors=True)
    OUT.mkdir(parents=True, exist_ok=True)
    table = Table()
    checks = {"intel": lambda: check_intel(table), "changed": lambda: check_changed(table, [1] if arguments.quick else [1, 2, 3, 4, 5]),
              "wean": lambda: check_wean(table),
              "demo": lambda: check_demo(table, [1] if arguments.quick else [1, 2, 3], 60 if arguments.quick else 300)}
    for name, check in checks.items():
        if arguments.only in (None, name):
            check()
    reports = sorted([*OUT.glob("*/report.json"), *OUT.glob("*/run/report.json")])
    settings = [line for line in settings_section(reports) if line.startswith("- ")]
    (OUT / "index.html").write_text(report_page("Figures promised and measured", [provenance() + "."] + settings,
                                                ["on", "figure", "measured", "at least", "met"], table.rows))
    if not arguments.quick and not arguments.only:
        text = "# Figures promised and measured\n\nWritten by `./dev check`: %s.\n\n%s\n\n%s\n" % (
            provenance(), table.markdown(), "\n".join(settings_section(reports)))
        (ROOT / "docs/results/check.md").write_text(text)
    raise SystemExit(0 if all(row[4] for row in table.rows) else 1)


main()
