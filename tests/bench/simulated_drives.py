# SPDX-License-Identifier: Apache-2.0
"""Recordings of the real daemon on simulated robots in real time, several at once."""
import pathlib
import random
import signal
import subprocess
import sys
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from project import ROOT, run

PATIENCE_S = 120.0
FAULTS = ["laser-noise:0.2", "laser-bit-flips:0.2", "laser-truncated:0.2", "laser-mute:4", "laser-cable-cut:4", "laser-restarts", "laser-repeats", "laser-dazzled",
          "laser-not-valid", "robot-noise:0.2", "robot-bit-flips:0.2", "robot-truncated:0.2", "robot-pauses:30", "robot-mute:4", "robot-deaf:4", "robot-cable-cut:4",
          "robot-restarts", "bumper:3", "stall", "stop-button", "controller-fault:1", "battery:11", "charge-state:1"]


class Drive:
    """One robot, its daemon and the recording of both in a folder of its own."""

    def __init__(self, bin, folder, world, seed, faults=(), settings=(), truth=False):
        self.folder = pathlib.Path(folder)
        self.folder.mkdir(parents=True)
        self.recording = self.folder / "drive.pcapng"
        scenario = ROOT / "config/scenarios" / (world + ".yaml")
        run(bin / "deltamap", "sim", "--world", scenario, "--write-map", self.folder / "map.yaml")
        words = [word for fault in faults for word in ("--fault", fault)] + (["--truth", self.folder / "truth.jsonl"] if truth else [])
        self.sim = subprocess.Popen([str(word) for word in [bin / "deltamap", "sim", "--world", scenario, "--links", self.folder, "--seed", seed, *words]],
                                    stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=(self.folder / "sim.log").open("w"))
        give_up_at = time.monotonic() + PATIENCE_S
        while not (self.folder / "laser").exists():
            if self.sim.poll() is not None or time.monotonic() > give_up_at:
                raise SystemExit("no simulator: " + (self.folder / "sim.log").read_text())
            time.sleep(0.05)
        places = {"robot.port": "robot", "laser.port": "laser", "control.socket": "ctl.sock", "map.store": "store.sqlite", "map.file": "map.yaml", "recording.file": "drive.pcapng"}
        words = ["%s=%s" % (key, self.folder / name) for key, name in places.items()] + ["dashboard.control=false", *settings]
        self.bin = bin
        self.daemon = subprocess.Popen([str(bin / "deltamapd"), "--config", str(ROOT / "config/simulation.yaml"), *["--set=" + word for word in words]],
                                       stdout=subprocess.DEVNULL, stderr=(self.folder / "daemon.log").open("w"))

    def wander(self):
        """Once the daemon answers; a fault may forbid it."""
        give_up_at = time.monotonic() + PATIENCE_S
        ctl = [str(self.bin / "deltamap"), "ctl", "--socket", str(self.folder / "ctl.sock")]
        while subprocess.run([*ctl, "status"], capture_output=True).returncode:
            if self.daemon.poll() is not None or time.monotonic() > give_up_at:
                raise SystemExit("no daemon: " + (self.folder / "daemon.log").read_text())
            time.sleep(0.1)
        subprocess.run([*ctl, "drive", "wander"], capture_output=True)

    def end(self):
        for process in (self.daemon, self.sim):
            process.send_signal(signal.SIGTERM)
            try:
                process.wait(timeout=PATIENCE_S)
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait()


def varied_drives(bin, folder, count, seconds, at_once, seed):
    """Recordings in which worlds, line speeds, variants of the laser and faults differ by chance; each as soon as its batch has ended."""
    dice = random.Random(seed)
    for first in range(0, count, at_once):
        batch = []
        try:
            for number in range(first, min(first + at_once, count)):
                faults = ["%d:%s" % (dice.randrange(2, int(seconds)), fault) for fault in dice.sample(FAULTS, dice.randrange(0, 4))]
                settings = ["laser.baud=%d" % dice.choice((9600, 19200, 38400, 500000)), "laser.variant=%s" % dice.choice(("180/1", "180/0.5", "100/0.25")),
                            "laser.units=%s" % dice.choice(("mm", "cm"))]
                batch.append(Drive(bin, folder / str(number), dice.choice(("hall", "room", "depot")), seed + number, faults, settings))
            for drive in batch:
                drive.wander()
            time.sleep(seconds)
        finally:
            for drive in batch:
                drive.end()
        yield from (drive.recording for drive in batch)
