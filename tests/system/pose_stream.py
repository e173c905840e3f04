#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""A planner in another process, with nothing but Python's standard library: the poses of a running daemon, over its socket
`poses.socket` alone (no page, no control socket). usage: pose_stream.py FOLDER-OF-PROGRAMS"""

import csv
import json
import math
import signal
import socket
import stat
import subprocess
import time

from live_trial import PATIENCE_S, ROOT, check, main, set_options, until

WORLD = ROOT / "config/scenarios/room.yaml"
SCANS = 40

# The schema of a line (docs/api.md): every key, and what its value may be.
NUMBER, TEXT, OBJECT = (int, float), str, dict
POSE = {"type": TEXT, "time": NUMBER, "scan": int, "x_m": NUMBER, "y_m": NUMBER, "heading_rad": NUMBER, "covariance": OBJECT, "state": TEXT, "verdict": TEXT,
        "pose_right": NUMBER, "map_wrong": NUMBER, "speed_m_per_s": NUMBER, "turn_rate_rad_per_s": NUMBER, "revision": int,
        "other_hypothesis": (dict, type(None)), "gate": (dict, type(None)), "latency_ms": NUMBER, "may_drive_by_pose": bool,
        "forbidden_by": TEXT}
COVARIANCE = {"xx_m2", "xy_m2", "yy_m2", "xh_m_rad", "yh_m_rad", "hh_rad2"}


class Poses:
    """The lines of `poses.socket`, as objects."""

    def __init__(self, path):
        self.socket = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
        self.socket.settimeout(PATIENCE_S)
        self.socket.connect(str(path))
        self.lines = self.socket.makefile("r", encoding="utf-8")

    def next(self):
        line = self.lines.readline()
        return json.loads(line) if line else None

    def close(self):
        self.lines.close()
        self.socket.close()


def check_pose(pose):
    check(pose.keys() == POSE.keys(), f"keys that differ from the schema: {sorted(pose.keys() ^ POSE.keys())}")
    for key, kind in POSE.items():
        check(isinstance(pose[key], kind) and (kind is bool or not isinstance(pose[key], bool)), f"{key} is {pose[key]!r}")
    check(pose["covariance"].keys() == COVARIANCE, "the covariance is not as in the schema")
    check(pose["covariance"]["xx_m2"] > 0 and pose["covariance"]["hh_rad2"] > 0, "a deviation is 0")
    check(pose["state"] in ("global", "tracking", "lost") and pose["verdict"] in ("right", "wrong", "undecided"), f"{pose['state']}, {pose['verdict']}")
    check(isinstance(pose["gate"]["open"], bool), "the gate is neither open nor shut")


def started(bin_folder, place, log, *options):
    settings = {"robot.port": place / "robot", "laser.port": place / "laser", "map.file": place / "m0.yaml", "poses.socket": place / "made/poses.sock",
                "map.store": "", "control.socket": "", "recording.file": ""}
    return subprocess.Popen([bin_folder / "deltamapd", "--config", "config/simulation.yaml", "--set", "dashboard.port=0", "--set", "dashboard.control=false",
                             "--initial-pose", "1,2,0", *set_options(settings), *options], stdout=log, stderr=log)


def run(bin_folder, place, log):
    path = place / "made/poses.sock"
    subprocess.run([bin_folder / "deltamap", "sim", "--world", WORLD, "--write-map", place / "m0.yaml"], check=True, stdout=log, stderr=log)
    processes = [subprocess.Popen([bin_folder / "deltamap", "sim", "--world", WORLD, "--links", place, "--seed", "1", "--truth", place / "truth.jsonl"], stdout=log, stderr=log)]
    try:
        until(lambda: (place / "robot").exists() and (place / "laser").exists(), "no simulator")
        processes.append(started(bin_folder, place, log))
        until(path.exists, "no socket")
        mode = stat.S_IMODE(path.stat().st_mode)
        check(mode == 0o660, f"the socket's permissions are {mode:o}")
        stalled, planner, leaves = Poses(path), Poses(path), Poses(path)
        hello = planner.next()
        check(hello["type"] == "hello" and hello["protocol"] == 1 and hello["version"], f"begins with {hello}")
        check(leaves.next()["type"] == "hello", "the second client was not greeted")
        leaves.close()
        poses = [planner.next() for _ in range(SCANS)]
        for pose in poses:
            check_pose(pose)
        for before, pose in zip(poses, poses[1:]):
            check(before["scan"] < pose["scan"] and before["time"] < pose["time"], f"time steps back: {before}, {pose}")
        # A busy machine may be late now and then, but not for ever.
        last, give_up_at = poses[-1], time.monotonic() + PATIENCE_S
        while not (0 < time.time() - last["time"] < 5 and last["state"] == "tracking"):
            check(time.monotonic() < give_up_at, f"at {time.time():.2f} the newest pose is late, or of a robot that is not tracked: {last}")
            last = planner.next()
        check(math.hypot(last["x_m"] - 1, last["y_m"] - 2) < 0.5, f"the robot stands at 1, 2: {last}")
        # A daemon that was killed leaves its socket: the next one takes it over.
        processes[1].send_signal(signal.SIGKILL)
        processes[1].wait()
        while planner.next() is not None:
            pass
        check(path.exists(), "a killed daemon cannot have removed its socket")
        processes[1] = started(bin_folder, place, log, "--out", place / "run")
        give_up_at = time.monotonic() + PATIENCE_S
        while True:
            check(time.monotonic() < give_up_at, "no poses after the restart")
            try:
                again = Poses(path)
                break
            except ConnectionRefusedError:
                time.sleep(0.05)
        check(again.next()["type"] == "hello", "no poses after the restart")
        scans = [again.next()["scan"] for _ in range(SCANS)]
        processes[1].terminate()
        check(processes[1].wait(PATIENCE_S) == 0, "the daemon did not end well")
        while again.next() is not None:
            pass
        # Where a busy machine has left out scans, nobody has their poses.
        with (place / "run/localization.csv").open() as rows:
            localized = [int(row["number"]) for row in csv.DictReader(rows)]
        wanted = [scan for scan in localized if scans[0] <= scan <= scans[-1]]
        check(scans == wanted, f"scans are missing: {scans} of {wanted}")
        check(not path.exists(), "the socket outlives its daemon")
        stalled.close()
    finally:
        for process in processes:
            process.kill()
            process.wait()


if __name__ == "__main__":
    main(run)
