#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Stops each thread of the real daemon in turn, one daemon a thread, all at once: systemd's watchdog must starve, the log must
name the stage, and both must end when the thread goes on. usage: watchdog.py FOLDER-OF-PROGRAMS"""
import concurrent.futures, ctypes, os, pathlib, re, socket, subprocess, sys, tempfile, time

from live_trial import PATIENCE_S, ROOT, check, set_options

STUCK_S = {"io": 10, "localization": 10, "delta": 10, "control": 10, "poses": 10, "map": 100, "recorder": 100}
EARLY = 0.5        # a look a second, and a machine that has other things to do
LATE_S = 40.0
STARVED_S = 16.0   # WatchdogSec of the unit, and a second
SEIZE, INTERRUPT, DETACH, ALL_CHILDREN = 0x4206, 0x4207, 17, 0x40000000
libc = ctypes.CDLL(None, use_errno=True)
libc.ptrace.argtypes = [ctypes.c_long, ctypes.c_long, ctypes.c_void_p, ctypes.c_void_p]


def trace(request, thread):
    if libc.ptrace(request, thread, None, None) != 0:
        raise OSError(ctypes.get_errno(), "ptrace: " + os.strerror(ctypes.get_errno()))


class Daemon:
    def __init__(self, bin, folder, first_map):
        self.notify = socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM)
        self.notify.bind(str(folder / "notify"))
        self.log = folder / "daemon.log"
        settings = {"robot.port": folder / "no_robot", "laser.port": folder / "no_laser", "map.file": first_map, "map.store": folder / "store.sqlite",
                    "recording.file": folder / "bytes.pcapng", "control.socket": folder / "ctl.sock", "poses.socket": folder / "poses.sock"}
        environment = dict(os.environ, NOTIFY_SOCKET=str(folder / "notify"), WATCHDOG_USEC="15000000")
        environment.pop("WATCHDOG_PID", None)
        self.process = subprocess.Popen([bin / "deltamapd", "--config", ROOT / "config/simulation.yaml", *set_options(settings)], cwd=ROOT,
                                        env=environment, stderr=open(self.log, "w"))

    def is_fed_within(self, seconds):
        until = time.monotonic() + seconds
        while (left := until - time.monotonic()) > 0:
            self.notify.settimeout(left)
            try:
                if b"WATCHDOG=1" in self.notify.recv(4096):
                    return True
            except socket.timeout:
                return False
        return False

    def thread(self, name):
        for task in pathlib.Path("/proc/%d/task" % self.process.pid).iterdir():
            if (task / "comm").read_text().strip() == name:
                return int(task.name)
        check(False, "the daemon has no thread " + name)

    def end(self):
        self.process.kill()
        self.process.wait()


def stuck(daemon, name):
    """What is wrong, or nothing."""
    if not daemon.is_fed_within(PATIENCE_S):
        return "not fed while everything moves"
    thread = daemon.thread(name)
    trace(SEIZE, thread)
    trace(INTERRUPT, thread)
    os.waitpid(thread, ALL_CHILDREN)
    began = fed = time.monotonic()
    while daemon.is_fed_within(STARVED_S):
        fed = time.monotonic()
        if fed - began > STUCK_S[name] + LATE_S:
            break
    if not EARLY * STUCK_S[name] < fed - began <= STUCK_S[name] + LATE_S:
        return "fed for %.1f s after it stood" % (fed - began)
    told = re.findall(r"watchdog is not fed: stage=(\w+) does not move", daemon.log.read_text())
    if not told or set(told) != {name}:
        return "the log names %s" % told
    trace(DETACH, thread)
    return None if daemon.is_fed_within(PATIENCE_S) else "not fed when it moves again"


def trial(bin, folder, first_map, name):
    folder.mkdir()
    daemon = Daemon(bin, folder, first_map)
    try:
        return stuck(daemon, name)
    except OSError as error:
        return str(error)
    finally:
        daemon.end()


def main():
    bin = pathlib.Path(sys.argv[1]).resolve()
    with tempfile.TemporaryDirectory() as out, concurrent.futures.ThreadPoolExecutor(len(STUCK_S)) as pool:
        out = pathlib.Path(out)
        subprocess.run([bin / "deltamap", "sim", "--world", ROOT / "config/scenarios/room.yaml", "--write-map", out / "m0.yaml"], check=True)
        wrong = dict(zip(STUCK_S, pool.map(lambda name: trial(bin, out / name, out / "m0.yaml", name), STUCK_S)))
    if any(why and "Operation not permitted" in why for why in wrong.values()):
        print("watchdog: SKIPPED: threads may not be stopped here")
        return 77
    for name, why in wrong.items():
        print("%s: %s" % (name, why or "starves the watchdog, and no more when it goes on"), file=sys.stderr if why else sys.stdout)
    return 1 if any(wrong.values()) else 0


if __name__ == "__main__":
    sys.exit(main())
