#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""What mapping costs a scan of 180 or 181 beams, in instructions that callgrind counts: Δ-awareness, averaged over all scans,
and the updates of the map beside it. On the real log `intel`, whose map lacks nothing, and in a simulated hall where a
container comes or goes each minute. Writes docs/results/mapping.md. Called by ./dev bench mapping.

  mapping.py [--quick]    --quick: two minutes of the hall alone, into build/"""
import argparse, re, subprocess

from measuring import LAB, OUT, ROOT, TOOL, mark, provenance, row, settings_section, table_lines, unpacked
from on_intel import KNOWN_START, missing_data, recording

AWARENESS = "deltamap::mapping::StoreScan::observe("
UPDATE = "deltamap::daemon::MapStep::update("
MOST = {"simulated hall": 280e3, "`intel`": 510e3}  # what it cost before maps were kept in tiles


def costs(profile):
    """{function: (calls, instructions with all that it called)} of a callgrind file."""
    names, found, callee, is_cost = {}, {}, None, False
    for line in profile.read_text().splitlines():
        named = re.match(r"(c?)fn=\((\d+)\)(?: (.*))?", line)
        if named:
            if named.group(3):
                names[named.group(2)] = named.group(3)
            if named.group(1):
                callee = named.group(2)
        elif line.startswith("calls="):
            calls, is_cost = int(line[6:].split()[0]), True
        elif is_cost:
            had = found.get(callee, (0, 0))
            found[callee] = (had[0] + calls, had[1] + int(line.split()[1]))
            is_cost = False
    return {names[number]: cost for number, cost in found.items()}


def measured(what, *command):
    """Instructions a scan: of awareness and of updates; how many updates there were."""
    OUT.mkdir(parents=True, exist_ok=True)
    profile = OUT / (what + ".callgrind")
    done = subprocess.run(["valgrind", "--tool=callgrind", "--callgrind-out-file=%s" % profile, "--collect-atstart=no",
                           "--toggle-collect=%s*" % AWARENESS, "--toggle-collect=%s*" % UPDATE, *map(str, command)],
                          cwd=ROOT, text=True, capture_output=True)
    found = costs(profile) if profile.exists() else {}
    total = {wanted: [sum(x) for x in zip((0, 0), *(cost for name, cost in found.items() if name.startswith(wanted)))]
             for wanted in (AWARENESS, UPDATE)}
    scans = total[AWARENESS][0]
    if not scans:
        raise SystemExit("callgrind on %s saw no scan:\n%s%s" % (what, done.stdout, done.stderr))
    return total[AWARENESS][1] / scans, total[UPDATE][1] / scans, total[UPDATE][0], scans


def rows_of(where, measure):
    awareness, update, updates, scans = measure
    both = awareness + update
    return [row("awareness a scan, " + where, "%.0f thousand instructions" % (awareness / 1e3)),
            row("updates of the map, averaged over the scans, " + where,
                "%.0f thousand instructions (%d sets in %d scans)" % (update / 1e3, updates, scans)),
            row("both together, " + where, "%.0f thousand instructions" % (both / 1e3), "≤ %.0f thousand" % (MOST[where] / 1e3), both <= MOST[where])]


def intel():
    unpacked("maps/ref_intel.pgm")
    return measured("intel", TOOL, "replay", recording(), "--map", unpacked("maps/ref_intel.yaml"), "--config", ROOT / "config/pioneer.yaml",
                    "--out", OUT / "intel-mapping", "--set", "laser.mount.x_m=0", "--initial-pose", KNOWN_START)


def hall(minutes):
    return measured("hall", LAB, "table2", "--only", "evidence", "--repeats", 1, "--jobs", 1, "--minutes", minutes,
                    "--out", OUT / "hall-mapping")


def made_by(quick):
    files = [OUT / "hall-mapping/summary.json"] + ([] if quick or missing_data() else [OUT / "intel-mapping/report.json"])
    return [file for file in files if file.exists()]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--quick", action="store_true")
    quick = parser.parse_args().quick
    rows = rows_of("simulated hall", hall(2 if quick else 10))
    if not quick:
        rows += missing_data() or rows_of("`intel`", intel())
    for one in rows:
        print("%-10s %s: %s (%s)" % (mark(one), one["figure"], one["ours"], one["target"]), flush=True)
    target = OUT / "mapping.md" if quick else ROOT / "docs/results/mapping.md"
    target.write_text("\n".join(["# What mapping costs a scan", "", "Written by `./dev bench mapping`: %s." % provenance(), "",
                                 *table_lines(rows), "", *settings_section(made_by(quick))]) + "\n")
    raise SystemExit(0 if all(one["met"] is not False for one in rows) else 1)


main()
