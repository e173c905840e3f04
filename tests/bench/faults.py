#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""What devices, lines and people do to the drivers, and how soon they deliver again: ./dev bench faults."""
import collections
import json
import os
import pathlib
import random
import signal
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from project import ROOT, measure_a_section, run

BIN = ROOT / "build/release/bin"
RUNS, QUICK_RUNS = 1000, 50
NOTICED_S = 3.0     # shorter ones may be over before anything is missed
LIVE_FAULTS = 30
LIVE_PAUSE_S = 1.0
SILENT_S = 10.0     # of the pose stream: then a thread hangs
# They cost neither a scan nor a packet while everything works: nothing is asked of the laser then, and a telegram may take its time.
COSTS_NOTHING = {"laser-deaf", "laser-naks", "laser-no-acks", "laser-pauses", "robot-pauses", "clock-leaps"}


def table(rows):
    head, *rest = rows
    return ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)] + ["| " + " | ".join(row) + " |" for row in rest]


def virtual(seed, quick):
    """Drivers and devices in virtual time."""
    told = [json.loads(line) for line in run(ROOT / "build/release/bench/driver_faults", ROOT / "config/scenarios/room.yaml",
                                             QUICK_RUNS if quick else RUNS, seed).splitlines()]
    faults = collections.defaultdict(list)
    for one in told:
        if "fault" in one:
            one["lines"] = [line for line in one["lines"] if not line.endswith("line is clean again")]  # that may be of the fault before
            faults[one["fault"]].append(one)
    drives = [one for one in told if "fault" not in one]
    rows = [("fault", "times", "delivers again, median s", "at most s", "late", "told", "what an operator reads first")]
    for name, of in sorted(faults.items()):
        waits = sorted(one["back_after_s"] for one in of)
        noticed = [one for one in of if one["lasted_s"] == 0 or one["lasted_s"] >= NOTICED_S]
        first = collections.Counter(one["lines"][0] for one in noticed if one["lines"])
        rows.append((name, str(len(of)), "%.1f" % waits[len(waits) // 2], "%.1f" % waits[-1], str(sum(not one["is_back_soon"] for one in of)),
                     "%d of %d" % (sum(bool(one["lines"]) for one in noticed), len(noticed)),
                     "costs nothing" if name in COSTS_NOTHING and not first else first.most_common(1)[0][0] if first else "**none**"))
    total = lambda name: sum(one[name] for one in drives)
    forbidden = collections.Counter(text for one in drives for text in one["forbidden"])
    late = sum(not one["is_back_soon"] for of in faults.values() for one in of)
    silent = [name for name, of in faults.items() if name not in COSTS_NOTHING and not any(one["lines"] for one in of)]
    lines = ["%d drives of 60 virtual seconds, %d faults drawn by seed: sessions, drive desk and safety as they ship, on the simulated devices in `room`, without a map; %.1f m driven in each on average." % (
        len(drives), sum(map(len, faults.values())), total("moved_m") / len(drives)),
        "*Delivers again*: from the end of the fault (`laser-restarts`: from the power cut, whose start-up takes up to 50 s) until odometry and scans are fresh. "
        "*Late*: after more than 3 s, and of `laser-restarts` 60 s. *Told*: of those that lasted %.0f s or were over in a moment; a robot that stands shows no fault of its wheels." % NOTICED_S,
        ""] + table(rows) + ["",
        "| what must not be | times |", "|---|---|",
        "| a frame that no device sent becomes data | %d |" % total("wrong_frames"),
        "| a scan that the laser has not measured | %d |" % total("wrong_scans"),
        "| a collision by its own wheels | %d |" % total("collisions"),
        "| the robot moves where it must stand (2.5 s without scans, 5 s without odometry, 3 s after what waits for a person) | %d%s |" % (
            sum(forbidden.values()), "".join("; %s: %d" % pair for pair in forbidden.most_common())),
        "| delivery that is late | %d |" % late,
        "| a fault that costs something and has no line | %s |" % (", ".join(silent) or "0")]
    return lines, not (total("wrong_frames") or total("wrong_scans") or total("collisions") or forbidden or late or silent)


class Live:
    """The daemon in real time on `deltamap sim`, which takes orders."""

    def __init__(self, folder):
        self.folder = folder
        self.sim = subprocess.Popen([BIN / "deltamap", "sim", "--world", ROOT / "config/scenarios/room.yaml", "--links", folder],
                                    stdin=subprocess.PIPE, stdout=subprocess.DEVNULL, stderr=(folder / "sim.log").open("w"), text=True)
        while not (folder / "laser").exists():
            time.sleep(0.1)
        places = {"robot.port": "robot", "laser.port": "laser", "control.socket": "ctl.sock", "map.store": "store.sqlite", "map.file": "map.yaml"}
        self.daemon = subprocess.Popen([BIN / "deltamapd", "--config", ROOT / "config/simulation.yaml"] + ["--set=%s=%s" % (key, folder / name) for key, name in places.items()] +
                                       ["--set=dashboard.control=false"], stdout=subprocess.DEVNULL, stderr=(folder / "log").open("w"))

    def order(self, text):
        self.sim.stdin.write(text + "\n")
        self.sim.stdin.flush()

    def ctl(self, *words):
        return subprocess.run([BIN / "deltamap", "ctl", "--socket", self.folder / "ctl.sock", *words], capture_output=True, text=True, timeout=30)

    def has_devices(self):
        status = self.ctl("status", "--json")
        if status.returncode:
            return False
        return set(json.loads(status.stdout)["ports"].values()) == {"up"}

    def descriptors(self):
        return len(list(pathlib.Path("/proc/%d/fd" % self.daemon.pid).iterdir()))

    def threads(self):
        return len(list(pathlib.Path("/proc/%d/task" % self.daemon.pid).iterdir()))

    def end(self):
        for process in (self.daemon, self.sim):
            process.send_signal(signal.SIGTERM)
        return [process.wait(timeout=30) for process in (self.daemon, self.sim)]


def until(holds, patience_s):
    began = time.monotonic()
    while time.monotonic() - began < patience_s:
        if holds():
            return True
        time.sleep(0.2)
    return False


def live(seed, quick):
    """Descriptors and threads of the daemon itself, on real ports that hang up."""
    chance = random.Random(seed)
    with tempfile.TemporaryDirectory(prefix="deltamap-faults-") as name:
        folder = pathlib.Path(name)
        run(BIN / "deltamap", "sim", "--world", ROOT / "config/scenarios/room.yaml", "--write-map", folder / "map.yaml")
        one = Live(folder)
        late = 0
        try:
            until(one.has_devices, 60.0)
            before = one.descriptors(), one.threads()
            count = LIVE_FAULTS // 6 if quick else LIVE_FAULTS
            for _ in range(count):
                fault = chance.choice(["robot-unplugged", "laser-unplugged", "robot-cable-cut", "laser-cable-cut", "robot-bit-flips", "laser-noise", "laser-truncated",
                                       "robot-restarts", "laser-restarts:2", "clock-leaps:3", "laser-wrong-baud", "stop-button"])
                lasts_s = 0.0 if "restarts" in fault or "clock" in fault else chance.uniform(0.5, 4.0)
                is_numbered = any(word in fault for word in ("flips", "noise", "truncated", "baud"))
                one.order(fault + (":" if is_numbered else "") + (":%.2f" % lasts_s if lasts_s else ""))
                time.sleep(lasts_s + LIVE_PAUSE_S)
                late += not until(one.has_devices, SILENT_S)
            after = one.descriptors(), one.threads()
        finally:
            codes = one.end()
    lines = ["The daemon in real time, %d faults one after another, adapters pulled and put back among them: open descriptors %d before and %d after, threads %d and %d; "
             "both devices back within %.0f s %d times; ended by SIGTERM with code %d." % (count, before[0], after[0], before[1], after[1], SILENT_S, count - late, codes[0])]
    return lines, after[0] <= before[0] and after[1] == before[1] and late == 0 and codes[0] == 0


def measure(seed, quick):
    parts = [virtual(seed, quick), live(seed, quick)]
    lines = []
    for text, _ in parts:
        lines += text + [""]
    return lines, all(is_met for _, is_met in parts)


if __name__ == "__main__":
    measure_a_section(__doc__, "./dev bench faults", "Faults", measure)
