#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""What the localizer costs beside an earlier commit of its own: instructions under callgrind, which repeat on any machine, and the ratio of
both. The earlier one is checked out and built below build/cost. Then what it costs beside others (beside_others.py). Called by ./dev bench
cost.
usage: cost.py [COMMIT] [--out FILE]    COMMIT: by default the one that the targets were set against"""
import argparse, pathlib, subprocess, sys

sys.path.insert(0, str(pathlib.Path(__file__).parent))
import beside_others, localizer_cost
from measuring import ROOT, provenance, row, run, table_lines

FIRST = "38c24d49"
KNOWN, LAST = 300, 900  # scans: from the first of these on the surfaces of the hall are known
ODOMETER = "*odometer::ScanWitness::observe*"
# What is done, beams (0: all 181), and what it is called.
JOBS = [("update", 60, "a whole update, 500 × 60"), ("update", 0, "a whole update, 500 × 181"),
        ("weigh", 60, "weighing, per particle and beam, 60 beams"),
        ("patch", 0, "a 5 × 5 m container patched into a 700² field")]


def built(commit):
    """localizer_cost of that commit."""
    folder = ROOT / "build/cost" / commit
    if not folder.exists():
        run("git", "worktree", "prune")
        run("git", "worktree", "add", "--detach", folder, commit)
    print("cost: building %s …" % commit, file=sys.stderr, flush=True)
    for command in (["cmake", "--preset", "release"], ["cmake", "--build", "--preset", "release", "--target", "localizer_cost"]):
        if subprocess.run(command, cwd=folder, stdout=subprocess.DEVNULL).returncode:
            raise SystemExit("cost: %s does not build; see above" % commit)
    return folder / "build/release/bench/localizer_cost"


def a_scan(program, beams, within="measured(*"):
    """Instructions of one that is tracked once all surfaces are known; 0 where there is no such function."""
    first, last = (localizer_cost.counted(program, "track", beams, scans, within)[0] for scans in (KNOWN, LAST))
    return (last - first) / (LAST - KNOWN)


def compared(name, before, now, most=None):
    print("cost: %s: %.3g -> %.3g" % (name, before, now), file=sys.stderr, flush=True)
    share = now / before
    return row(name, "%.3g; %.2f of it" % (now, share), "≤ %.2f" % most if most else "", share <= most if most else None, "%.3g" % before)


def tracking_rows(earlier):
    now = localizer_cost.X86_64
    made = [compared("a scan tracked, KLD and refinement, static hall, 60 beams, once its surfaces are known", a_scan(earlier, 60), a_scan(now, 60), 0.66)]
    had, has = (a_scan(program, 60, ODOMETER) for program in (earlier, now))
    made.append(row("of it the laser odometer", "%.3g" % has, "", None, "%.3g" % had if had else "there was none"))
    return made + [compared("the same scan, 181 beams", a_scan(earlier, 0), a_scan(now, 0))]


def rows(earlier):
    made = tracking_rows(earlier)
    for what, beams, name in JOBS:
        before, now = (localizer_cost.instructions(program, what, beams) for program in (earlier, localizer_cost.X86_64))
        made.append(compared(name, before, now))
    return made


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("commit", nargs="?", default=FIRST)
    parser.add_argument("--out", type=pathlib.Path, default=ROOT / "docs/results/cost.md")
    arguments = parser.parse_args()
    commit = run("git", "rev-parse", "--short=8", arguments.commit).strip()
    made = rows(built(commit))
    text = "\n".join(["# What the localizer costs", "", "Written by `./dev bench cost %s`: %s." % (commit, provenance()), "",
                      "## Beside an earlier commit", "", "Instructions that callgrind counts for one unit of each; they repeat on any processor that has AVX2.", "",
                      *table_lines(made, "at %s" % commit), "",
                      "## Beside others", "", "CPU time of one thread on the processor named above. pf-localization runs here, where it is installed; figures of others are constants,",
                      "measured once on one machine on the same drives, as in [the localizer, measured](localization.md).", "",
                      *table_lines(beside_others.rows()), ""])
    arguments.out.write_text(text)
    print(text)


if __name__ == "__main__":
    main()
