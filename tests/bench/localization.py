#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Measures every figure that the localizer promises, beside those of its peers, and writes docs/results/localization.md.
Called by ./dev bench localization.

  localization.py [--quick] [--only NAME]...   --quick: few repetitions, seeds and runs; writes into build/ alone
                                               --only: measures these parts anew and keeps what is known of the others"""
import argparse, json, os, pathlib, sys

sys.path.insert(0, str(pathlib.Path(__file__).parent))
import localizer_cost, on_experiments, on_intel
from measuring import OUT, ROOT, mark, provenance, run, settings_section, table_lines

# In the order of the table. Each answers a list of rows.
PARTS = {
    "cost": localizer_cost.rows,
    "patch": localizer_cost.patch_rows,
    "memory": localizer_cost.memory_rows,
    "hall": on_experiments.hall_rows,
    "stale-map": on_experiments.stale_map_rows,
    "verdict": on_experiments.verdict_rows,
    "intel": on_intel.known_start_rows,
    "global": on_intel.global_start_rows,
    "warehouse": localizer_cost.warehouse_rows,
}


def made_by():
    return sorted(file for name in ("report", "summary") for file in (OUT / "runs").glob("*/%s.json" % name))


def markdown(parts):
    revisions = sorted({part["revision"] for part in parts.values()})
    lines = ["# The localizer, measured", "",
             "Written by `./dev bench localization` at %s: %s. Times are CPU time of one thread, medians; peers' figures were"
             % (", ".join(revisions), provenance()),
             "measured on one machine on the same logs with 500 particles and 60 beams. Instructions are those that callgrind counts:",
             "they repeat on any processor that has AVX2 (32-bit build: on any). Load of the machine at the end: %.1f on %d processors."
             % (os.getloadavg()[0], os.cpu_count()), ""]
    lines += table_lines([row for part in parts.values() for row in part["rows"]])
    judged = [row["met"] for part in parts.values() for row in part["rows"] if row["met"] is not None]
    lines += ["", "%d of %d met." % (sum(judged), len(judged)), "", *settings_section(made_by()), ""]
    return "\n".join(lines)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--only", choices=list(PARTS), action="append")
    arguments = parser.parse_args()
    folder = OUT / ("quick" if arguments.quick else "full")
    folder.mkdir(parents=True, exist_ok=True)
    revision = run("git", "describe", "--always", "--dirty").strip()
    known = {}
    for name, measure in PARTS.items():
        kept = folder / (name + ".json")
        if name in (arguments.only or PARTS):
            rows = measure(arguments.quick)
            kept.write_text(json.dumps({"revision": revision, "rows": rows}, indent=1, ensure_ascii=False))
            for row in rows:
                print("%-10s %s: %s (%s)" % (mark(row), row["figure"], row["ours"], row["target"]), flush=True)
        if kept.exists():
            known[name] = json.loads(kept.read_text())
    (folder / "localization.json").write_text(json.dumps(known, indent=1, ensure_ascii=False))
    target = folder / "localization.md" if arguments.quick else ROOT / "docs/results/localization.md"
    target.write_text(markdown(known))
    print("written: %s" % target.relative_to(ROOT))
    raise SystemExit(0 if all(row["met"] is not False for part in known.values() for row in part["rows"]) else 1)


main()
