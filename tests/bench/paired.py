#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Compares two results of one experiment run by run: did a change move the median or the tail, or is it chance?

    tests/bench/paired.py BEFORE AFTER [--figure NAME]...

BEFORE and AFTER are folders that `deltamap-lab NAME --out` has left. For every figure it prints median, nine of
ten and worst of both, in how many runs it became better and worse, and the two-sided p of a sign test: the chance of
so uneven a count if the change did nothing.
"""
import argparse
import csv
import math
import pathlib
import sys

# Of these more is better; of all others less.
MORE_IS_BETTER = {"recall", "precision", "skill", "inside_95", "inside_95_after_slip", "start_found", "f1",
                  "acceptance", "walls_kept", "changes_found", "layer_recall", "acceptance_solid"}
FIGURES = ["error_rms_m", "laser_error_rms_m", "error_most_m", "off_share", "stretches_off", "jumps", "found_after_s",
           "wrong_before_found_s", "searching_while_near_s", "recall", "precision", "skill", "gate_shut_while_right",
           "cells_written_astray", "wall_drift_m", "inside_95", "inside_95_after_slip", "localizer_cpu_ms",
           "mapping_cpu_ms"]
SAME = 1e-9  # relative; closer values are equal


def runs_in(folder):
    """The rows of NAME.csv by the run's name."""
    tables = sorted(pathlib.Path(folder).glob("*.csv"))
    if len(tables) != 1:
        raise SystemExit(f"paired: {folder}: expected one NAME.csv, found {len(tables)}")
    with open(tables[0], newline="", encoding="utf-8") as table:
        return {row["run"]: row for row in csv.DictReader(table)}


def number(row, figure):
    """None where the run has no such number."""
    try:
        value = float(row.get(figure) or "nan")
    except ValueError:
        return None
    return None if math.isnan(value) else value


def quantile(values, share):
    """The smallest value that at least this share of all does not exceed, as in the experiments."""
    ranked = sorted(values)
    return ranked[max(0, math.ceil(share * len(ranked)) - 1)]


def spread(values, figure):
    """Median, nine of ten and worst."""
    sign = -1.0 if figure in MORE_IS_BETTER else 1.0
    costs = [sign * value for value in values]
    return [sign * quantile(costs, share) for share in (0.5, 0.9, 1.0)]


def sign_test(better, worse):
    """Two-sided p of the counts if each were as likely as the other; equal pairs say nothing."""
    count = better + worse
    if count == 0:
        return 1.0
    tail = sum(math.comb(count, k) for k in range(min(better, worse) + 1)) / 2.0**count
    return min(1.0, 2.0 * tail)


def compared(before, after, figure):
    """The figure over the runs that have it on both sides; None where none has."""
    pairs = []
    for run in before:
        if run in after:
            pair = number(before[run], figure), number(after[run], figure)
            if None not in pair:
                pairs.append(pair)
    if not pairs:
        return None
    sign = -1.0 if figure in MORE_IS_BETTER else 1.0
    moved = [sign * (new - old) for old, new in pairs if abs(new - old) > SAME * max(abs(new), abs(old))]
    better = sum(1 for step in moved if step < 0.0)
    worse = len(moved) - better
    return {"figure": figure, "runs": len(pairs), "before": spread([old for old, _ in pairs], figure),
            "after": spread([new for _, new in pairs], figure), "better": better, "worse": worse,
            "p": sign_test(better, worse)}


def printed(rows):
    def three(values):
        return " ".join(f"{value:>9.4g}" for value in values)

    head = f"{'figure':<24} {'runs':>4}  {'before: median, 9 of 10, worst':<30} {'after':<30} better worse      p"
    lines = [head]
    for row in rows:
        lines.append(f"{row['figure']:<24} {row['runs']:>4}  {three(row['before']):<30} {three(row['after']):<30} "
                     f"{row['better']:>6} {row['worse']:>5} {row['p']:>6.2g}")
    return "\n".join(lines)


def main(arguments):
    parser = argparse.ArgumentParser(description="compares two results of one experiment run by run")
    parser.add_argument("before", help="folder of results")
    parser.add_argument("after", help="folder of results")
    parser.add_argument("--figure", action="append", help="column of NAME.csv; repeatable (default: a choice)")
    given = parser.parse_args(arguments)
    before, after = runs_in(given.before), runs_in(given.after)
    if not before.keys() & after.keys():
        raise SystemExit("paired: the two folders have no run in common")
    rows = [compared(before, after, figure) for figure in given.figure or FIGURES]
    rows = [row for row in rows if row]
    if not rows:
        raise SystemExit("paired: none of the figures is in both folders")
    print(printed(rows))
    left = len(before.keys() ^ after.keys())
    if left:
        print(f"{left} runs are in one folder only and were left out")


if __name__ == "__main__":
    main(sys.argv[1:])
