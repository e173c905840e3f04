#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""What a daemon keeps of bad moments, and what that costs: ./dev bench incidents."""
import collections
import csv
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from project import ROOT, measure_a_section, run

BIN = ROOT / "build/release/bin"
LIVE_S = 160.0      # more than the ring holds
MARK_AT_S = 150.0
SOON_S = 2.0
MOST_MB = 4.0
LEAST_BEFORE_S = 120.0
LEAST_SHARE = 0.95


def table(rows):
    head, *rest = rows
    return ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)] + ["| " + " | ".join(row) + " |" for row in rest]


def drives(seed, quick):
    """The experiment's table, a line a cause, and whether its losses are met again."""
    with tempfile.TemporaryDirectory(prefix="deltamap-incidents-") as out:
        run(BIN / "deltamap-lab", "incidents", "--out", out, "--seed", seed, "--jobs", os.cpu_count(), *(["--quick"] if quick else []))
        runs = list(csv.DictReader((pathlib.Path(out) / "incidents.csv").open()))
    causes = collections.defaultdict(list)
    for one in runs:
        causes[one["cause"]].append(one)
    total = lambda of, name: sum(float(one[name]) for one in of)
    rows = [("cause", "drives", "with an incident", "kinds", "losses", "met again within 2 s")]
    for cause, of in causes.items():
        kinds = collections.Counter(kind for one in of for kind in one["kinds"].split(", ") if kind)
        rows.append((cause, str(len(of)), str(sum(float(one["incidents"]) > 0 for one in of)),
                     ", ".join("%s %d" % pair for pair in kinds.most_common()) or "none", "%.0f" % total(of, "losses"), "%.0f" % total(of, "met_within_2_s")))
    losses, soon = total(runs, "losses"), total(runs, "met_within_2_s")
    before_s = min(float(one["least_before_s"]) for one in runs)
    largest = max(float(one["largest_mb_on_disk"]) for one in runs)
    lines = ["%d drives in virtual time (`deltamap-lab incidents`); after 150 s something befalls the robot, and it goes on for 140 s. Kinds: in how many drives." % len(runs),
             ""] + table(rows) + ["", "Of %.0f losses a replay of the incident meets %.0f in the same way within 2 s; kept before an event: %.0f s at least, where the run had lasted that long; the largest incident has %.1f MB (laser at 38400 baud)." % (
                 losses, soon, before_s, largest)]
    return lines, before_s >= LEAST_BEFORE_S and soon >= LEAST_SHARE * losses


def kills():
    """The test that kills a keeper at random moments."""
    done = subprocess.run([ROOT / "build/release/tests/daemon_incident_tests", "--gtest_filter=IncidentKill.*", "--gtest_repeat=5"], capture_output=True, text=True)
    return ["Killed (SIGKILL) at 300 random moments while it keeps one incident after another: every incident that was there was whole: %s (`IncidentKill`)." % (
        "yes" if done.returncode == 0 else "**no**")], done.returncode == 0


class Live:
    """A daemon in real time on a simulated robot whose laser sends at 500000 baud."""

    def __init__(self, folder, keeps):
        self.folder = pathlib.Path(folder)
        self.sim = subprocess.Popen([BIN / "deltamap", "sim", "--world", ROOT / "config/scenarios/hall.yaml", "--links", self.folder], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        while not (self.folder / "laser").exists():
            time.sleep(0.1)
        places = {"robot.port": "robot", "laser.port": "laser", "control.socket": "ctl.sock", "map.store": "store.sqlite"}
        words = ["--set=%s=%s" % (key, self.folder / name) for key, name in places.items()]
        words += ["--set=map.file=%s" % (self.folder / "map.yaml"), "--set=laser.baud=500000", "--set=dashboard.control=false"]
        if keeps:
            words.append("--set=incidents.folder=%s" % (self.folder / "incidents"))
        self.daemon = subprocess.Popen([BIN / "deltamapd", "--config", ROOT / "config/simulation.yaml", *words], stdout=subprocess.DEVNULL, stderr=(self.folder / "log").open("w"))

    def ctl(self, *words):
        return subprocess.run([BIN / "deltamap", "ctl", "--socket", self.folder / "ctl.sock", *words], capture_output=True, text=True)

    def cost(self):
        """CPU seconds and the peak of resident memory, MB."""
        fields = pathlib.Path("/proc/%d/stat" % self.daemon.pid).read_text().rsplit(") ", 1)[1].split()
        status = pathlib.Path("/proc/%d/status" % self.daemon.pid).read_text()
        peak_kb = int(next(line.split()[1] for line in status.splitlines() if line.startswith("VmHWM")))
        return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK"), peak_kb / 1024.0

    def end(self):
        for process in (self.daemon, self.sim):
            process.send_signal(signal.SIGTERM)
            process.wait(timeout=30)


def cost(quick):
    """What two daemons cost, one of which keeps incidents."""
    with tempfile.TemporaryDirectory(prefix="deltamap-with-") as one, tempfile.TemporaryDirectory(prefix="deltamap-without-") as other:
        for folder in (one, other):
            run(BIN / "deltamap", "sim", "--world", ROOT / "config/scenarios/hall.yaml", "--write-map", pathlib.Path(folder) / "map.yaml")
        lives = [Live(one, True), Live(other, False)]
        try:
            time.sleep(10.0)
            for live in lives:
                live.ctl("drive", "wander")
            time.sleep((30.0 if quick else MARK_AT_S) - 10.0)
            ring = sum(file.stat().st_size for file in (lives[0].folder / "incidents/.ring").iterdir())
            held_s = min(130.0, 30.0 if quick else MARK_AT_S)
            began = time.monotonic()
            marked = lives[0].ctl("mark", "measured")
            took_s = time.monotonic() - began
            time.sleep(LIVE_S - MARK_AT_S)
            (cpu_with, peak_with), (cpu_without, peak_without) = (live.cost() for live in lives)
        finally:
            for live in lives:
                live.end()
    met = marked.returncode == 0 and took_s <= SOON_S and peak_with - peak_without <= MOST_MB
    rows = [("", "with incidents", "without"),
            ("CPU of the daemon, s in %.0f s" % (40.0 if quick else LIVE_S), "%.1f" % cpu_with, "%.1f" % cpu_without),
            ("peak of its resident memory, MB", "%.1f" % peak_with, "%.1f" % peak_without)]
    lines = ["Two daemons in real time on simulated robots in `hall`, laser at 500000 baud:", ""] + table(rows)
    lines += ["", "The ring held %.1f MB on disk, about %.0f kB/s. An incident was on disk %.2f s after `ctl mark` was typed." % (1e-6 * ring, 1e-3 * ring / held_s, took_s)]
    return lines, met


def measure(seed, quick):
    parts = [drives(seed, quick), kills(), cost(quick)]
    lines = []
    for text, _ in parts:
        lines += text + [""]
    return lines, all(is_met for _, is_met in parts)


if __name__ == "__main__":
    measure_a_section(__doc__, "./dev bench incidents", "Incidents", measure)
