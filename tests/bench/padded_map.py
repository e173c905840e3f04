#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""What unknown space around a map costs: the real log `intel` is replayed on its own map, padded on all sides with unknown
cells to a multiple of its side. Writes docs/results/padded_map.md. Called by ./dev bench padded.

  padded_map.py [--quick]    --quick: the map itself and twice its side, once each, into build/"""
import argparse, json

from measuring import OUT, ROOT, TOOL, mark, median, provenance, row, run, settings_section, table_lines, unpacked
from on_intel import KNOWN_START, missing_data, recording

MOST_MIB = {1: 23, 2: 25, 4: 28, 8: 40}  # by multiple of the side
FLAT = 0.10                              # CPU a scan may be so much more than on the map itself
UNKNOWN = bytes([205])


def padded_map(times):
    """The map's YAML file, with the map in the middle of a rectangle of so many times its side."""
    keys = dict(line.split(": ", 1) for line in unpacked("maps/ref_intel.yaml").read_text().splitlines())
    pgm = unpacked("maps/ref_intel.pgm").read_bytes()
    magic, width, height, brightest = pgm.split(None, 4)[:4]
    header = len(pgm) - int(width) * int(height)
    pixels, width, height = pgm[header:], int(width), int(height)
    left, low = (times - 1) * width // 2, (times - 1) * height // 2
    wide = times * width
    image = OUT / ("padded-%d.pgm" % times)
    with open(image, "wb") as out:
        out.write(b"P5\n%d %d\n255\n" % (wide, times * height))
        out.write(UNKNOWN * (wide * (times * height - height - low)))
        for begin in range(0, len(pixels), width):
            out.write(UNKNOWN * left + pixels[begin:begin + width] + UNKNOWN * (wide - width - left))
        out.write(UNKNOWN * (wide * low))
    resolution, origin = float(keys["resolution"]), json.loads(keys["origin"])
    keys["image"] = image.name
    keys["origin"] = "[%.6g, %.6g, 0.0]" % (origin[0] - left * resolution, origin[1] - low * resolution)
    yaml = image.with_suffix(".yaml")
    yaml.write_text("".join("%s: %s\n" % key for key in keys.items()))
    return yaml, times * times * width * height


def replayed(times, number):
    folder = OUT / "runs" / ("padded-%d-%d" % (times, number))
    yaml, cells = padded_map(times)
    run(TOOL, "replay", recording(), "--map", yaml, "--config", ROOT / "config/pioneer.yaml", "--out", folder,
        "--set", "laser.mount.x_m=0", "--initial-pose", KNOWN_START)
    return json.loads((folder / "report.json").read_text()), cells, folder / "report.json"


def rows_of(multiples, runs):
    """The rows of the table and the reports that they were read from."""
    made, reports, first = [], [], None
    for times in multiples:
        done = [replayed(times, number) for number in range(runs)]
        reports += [file for _, _, file in done]
        ms = median([report["cpu"]["per_scan_ms"] for report, _, _ in done])
        mib = median([report["peak_resident_bytes"] for report, _, _ in done]) / 2**20
        revisions = done[0][0]["revisions_total"]
        first = first or (ms, revisions)
        what = "%d × the side, %.1f million cells: " % (times, done[0][1] / 1e6)
        made += [row(what + "CPU a scan", "%.3f ms" % ms, "≤ %.3f ms" % ((1 + FLAT) * first[0]), ms <= (1 + FLAT) * first[0]),
                 row(what + "peak of resident memory", "%.1f MiB" % mib, "≤ %d MiB" % MOST_MIB[times], mib <= MOST_MIB[times]),
                 row(what + "revisions", "%d" % revisions, "= %d" % first[1], revisions == first[1])]
    return made, reports


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--quick", action="store_true")
    quick = parser.parse_args().quick
    OUT.mkdir(parents=True, exist_ok=True)
    rows, reports = (missing_data(), []) if missing_data() else rows_of([1, 2] if quick else sorted(MOST_MIB), 1 if quick else 5)
    for one in rows:
        print("%-10s %s: %s (%s)" % (mark(one), one["figure"], one["ours"], one["target"]), flush=True)
    target = OUT / "padded_map.md" if quick else ROOT / "docs/results/padded_map.md"
    target.write_text("\n".join(["# What unknown space around a map costs", "", "Written by `./dev bench padded`: %s." % provenance(), "",
                                 "The real log `intel`, replayed on its map padded with unknown cells on all sides.", "",
                                 *table_lines(rows), "", *settings_section(reports)]) + "\n")
    raise SystemExit(0 if all(one["met"] is not False for one in rows) else 1)


main()
