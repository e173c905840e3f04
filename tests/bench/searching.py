#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Whether `deltamap sweep --optimize` finds its way out of settings that are wrong on purpose, held against the best of many random settings:
./dev bench searching."""
import json
import math
import os
import pathlib
import random
import re
import statistics
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from project import ROOT, measure_a_section, run
from simulated_drives import Drive

BIN = pathlib.Path(os.environ.get("DELTAMAP_BIN", ROOT / "build/release/bin"))
# Key: what is wrong, and the range that is searched.
KEYS = {"localization.field.hit_deviation_m": ("0.6", 0.03, 0.9), "localization.field.random_share": ("0.2", 0.02, 0.2),
        "localization.motion.turn_per_turn": ("1.5", 0.02, 2.0), "laser.range_deviation_m": ("0.25", 0.008, 0.3)}
IDLE = {"localization.global.converged_after_m": (1.0, 8.0)}  # of a search that this drive, whose start is given, never makes
BY, BUDGET, SEARCHES, RANDOM, SECONDS, AT_ONCE, TEST_SEEDS = "error_p95_m", 200, 10, 2000, 45.0, 100, 8
START = "2.5,2.5,0"


class Tuned:
    def __init__(self, place, seed):
        self.place = pathlib.Path(place)
        self.drives = []
        for name in ("searched", "held out"):
            drive = Drive(BIN, self.place / name, "hall", seed + len(self.drives), truth=True)
            try:
                drive.wander()
                time.sleep(SECONDS)
            finally:
                drive.end()
            self.drives.append(drive)
        self.wrong = {key: wrong for key, (wrong, _, _) in KEYS.items()}

    def of(self, drive):
        folder = self.drives[drive].folder
        return [self.drives[drive].recording, "--map", folder / "map.yaml", "--truth", folder / "truth.jsonl", "--initial-pose=" + START, "--jobs", 1, "--by", BY, "--json"]

    def config(self, name, values):
        file = self.place / (name + ".yaml")
        file.write_text(run(BIN / "deltamapd", "--config", ROOT / "config/simulation.yaml", *["--set=%s=%s" % pair for pair in values.items()], "--print-config"))
        return file

    def search(self, ranges, base, budget, seed):
        """Values of the winner, and what is told of it."""
        words = ["--param=%s=%g:%g:2:log" % (key, low, high) for key, (low, high) in ranges.items()]
        told = json.loads(run(BIN / "deltamap", "sweep", *self.of(0), "--config", self.config("base", base), *words, "--optimize", budget, "--search-seed", seed,
                              "--out", self.place / "sweep", "--anew"))
        return {**base, **{key: str(value) for key, value in (told.get("winner") or {}).items()}}, json.dumps(told)

    def errors(self, drive, configs, seeds):
        """Mean of the measure for each."""
        runs = json.loads(run(BIN / "deltamap", "compare", *self.of(drive), *["--config=%s" % config for config in configs], "--seeds", seeds))["runs"]
        names = list(dict.fromkeys(one["setting"] for one in runs))
        return [statistics.mean(math.inf if one[BY] is None else one[BY] for one in runs if one["setting"] == name) for name in names]


def verdict_of(told):
    return next((word for word in ("confirmed", "nothing") if re.search(r'"[^"]*\b%s\b' % word, told)), "untold")


def measure(seed, quick):
    searches, count = (2, 20) if quick else (SEARCHES, RANDOM)
    dice = random.Random(seed)
    with tempfile.TemporaryDirectory(prefix="deltamap-searching-") as place:
        tuned = Tuned(place, seed)
        began = time.monotonic()
        found = [tuned.search({key: (low, high) for key, (_, low, high) in KEYS.items()}, tuned.wrong, BUDGET, number + 1) for number in range(searches)]
        search_s = (time.monotonic() - began) / searches
        idle = [verdict_of(tuned.search(IDLE, {}, 60, number + 1)[1]) for number in range(2 if quick else SEARCHES)]
        drawn, began = [], time.monotonic()
        for number in range(count):
            drawn.append({key: "%.6g" % (low * (high / low) ** dice.random()) for key, (_, low, high) in KEYS.items()})
        costs = []
        for first in range(0, count, AT_ONCE):
            costs += tuned.errors(0, [tuned.config("random-%d" % number, drawn[number]) for number in range(first, min(first + AT_ONCE, count))], 1)
        random_s = time.monotonic() - began
        best = drawn[min(range(count), key=costs.__getitem__)]
        tried = [tuned.wrong, {}, best] + [values for values, _ in found]
        errors = tuned.errors(1, [tuned.config("tried-%d" % number, values) for number, values in enumerate(tried)], TEST_SEEDS)
    wrong, delivered, of_random, *of_found = [1000.0 * error for error in errors]
    verdicts = [verdict_of(told) for _, told in found]
    told = lambda all: "%d %s" % (all.count("confirmed"), "confirmed") + (", %d nothing" % all.count("nothing") if "nothing" in all else "")
    half = sum(error <= 0.5 * wrong for error in of_found)
    is_met = half >= 0.8 * searches and statistics.median(of_found) <= 1.25 * of_random and "confirmed" not in idle
    lines = ["A simulated drive of %.0f s in `hall`, with %d keys wrong on purpose (%s); the measure is `%s`, mm, on another drive in the same hall with %d seeds that no search has seen." % (
        SECONDS, len(KEYS), ", ".join("`%s: %s`" % pair for pair in tuned.wrong.items()), BY, TEST_SEEDS), "",
        "| settings | replays | %s, mm |" % BY, "|---|---|---|", "| wrong, as given | | %.1f |" % wrong, "| as delivered | | %.1f |" % delivered,
        "| best of %d random settings, by one replay each (%.0f s) | %d | %.1f |" % (count, random_s, count, of_random),
        "| found by `sweep --optimize %d`, median of %d searches (%.0f s each) | %d | %.1f |" % (BUDGET, searches, search_s, BUDGET, statistics.median(of_found)),
        "| best and worst of these searches | | %.1f to %.1f |" % (min(of_found), max(of_found)), "",
        "What the searches said of what they had found: %s. Of `%s`, which does nothing in this drive, %d searches from the settings as delivered said: %s." % (
            told(verdicts), next(iter(IDLE)), len(idle), told(idle)), "",
        "Asked for: at least 8 in 10 of the searches (here %d) halve the error, their median within a quarter of the best of the random ones, and no difference told where there is none: %s." % (
            searches, "met" if is_met else "**missed**")]
    return lines, is_met


if __name__ == "__main__":
    measure_a_section(__doc__, "./dev bench searching", "A search against random settings", measure)
