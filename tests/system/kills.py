#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Real daemon, simulated robot on pseudo-terminals, real time: kills it in mid-drive, or pulls the robot's cable, and
measures how far the robot goes on unspoken to and how soon it is back. What an operator has switched off must not move
again. usage: kills.py FOLDER-OF-PROGRAMS [KILLS] [PULLS] [SEED] [LATE_S]; a machine that is busy meanwhile needs more than the
3 s that are promised on one that is not"""
import json, math, os, pathlib, pty, random, select, signal, subprocess, sys, tempfile, termios, threading, time, tty

from live_trial import PATIENCE_S, ROOT, check, set_options, until

SOON = 0.95          # share of the trials that are not late
STANDS_S = 4.5       # watchdog 2 s, then braked
FARTHEST_M = 1.3     # the pilot's 0.5 m/s for 2 s and two SIP cycles, then braked at 1 m/s^2
PILOT_M_PER_S = 0.5


class Cable(threading.Thread):
    """Between the simulator's terminal and one of its own; speeds follow. Pulled out, its own end hangs up. `seen_as` names the
    own terminal for a daemon that sees it elsewhere."""

    def __init__(self, device, link, seen_as=lambda terminal: terminal):
        super().__init__(daemon=True)
        self.device = os.open(device, os.O_RDWR | os.O_NOCTTY | os.O_NONBLOCK)
        tty.setraw(self.device)
        self.seen_as = seen_as
        self.link, self.host, self.is_in, self.lock = pathlib.Path(link), None, False, threading.Lock()
        self.plug()
        self.start()

    def plug(self):
        with self.lock:
            self.host, slave = pty.openpty()
            tty.setraw(slave)
            self.link.symlink_to(self.seen_as(os.ttyname(slave)))
            os.close(slave)  # else a dead daemon's lock would outlive it
            self.is_in = True

    def pull(self):
        with self.lock:
            self.is_in = False
            self.link.unlink()
            os.close(self.host)

    def is_open_elsewhere(self):
        state = select.poll()
        state.register(self.host, select.POLLOUT)
        return not any(event & select.POLLHUP for _, event in state.poll(0))

    def passed_on(self, data):
        """What arrives of what the device has said."""
        return data

    def run(self):
        speed = None
        while True:
            select.select([self.device], [], [], 0.002)
            with self.lock:
                try:
                    is_open = self.is_in and self.is_open_elsewhere()
                    if is_open:
                        now = termios.tcgetattr(self.host)[4]
                        if now != speed:
                            settings = termios.tcgetattr(self.device)
                            settings[4] = settings[5] = speed = now
                            termios.tcsetattr(self.device, termios.TCSANOW, settings)
                        if select.select([self.host], [], [], 0)[0]:
                            os.write(self.device, os.read(self.host, 4096))
                    if select.select([self.device], [], [], 0)[0]:
                        data = os.read(self.device, 4096)
                        if is_open and data:
                            os.write(self.host, self.passed_on(data))
                except OSError:
                    pass


class Trial:
    def __init__(self, bin, out, seed, cable=Cable):
        self.bin, self.out, self.random = pathlib.Path(bin).resolve(), pathlib.Path(out), random.Random(seed)
        world = ["--world", str(ROOT / "config/scenarios/room.yaml")]
        subprocess.run([self.bin / "deltamap", "sim", *world, "--write-map", self.out / "m0.yaml"], check=True)
        (self.out / "sim").mkdir()
        self.sim = subprocess.Popen([self.bin / "deltamap", "sim", *world, "--links", self.out / "sim", "--truth",
                                     self.out / "truth.jsonl", "--seed", str(seed)], stderr=open(self.out / "sim.log", "w"))
        until(lambda: (self.out / "sim/laser").exists(), "no simulator")
        self.cable = cable(self.out / "sim/robot", self.out / "robot")
        self.daemon = None
        self.settings = {}  # others than those of each start

    def start(self):
        pose = "null" if self.daemon else "[1,2,0]"  # later it is where the run before has kept it
        settings = {"localization.initial_pose": pose, "robot.port": self.out / "robot", "laser.port": self.out / "sim/laser", "map.file": self.out / "m0.yaml",
                    "map.store": self.out / "store.sqlite", "control.socket": self.out / "ctl.sock", **self.settings}
        self.daemon = subprocess.Popen([self.bin / "deltamapd", "--config", ROOT / "config/simulation.yaml",
                                        *set_options(settings)], cwd=ROOT, stderr=open(self.out / "daemon.log", "a"))

    def ask(self, *words):
        done = subprocess.run([self.bin / "deltamap", "ctl", "--socket", self.out / "ctl.sock", "--json", *words],
                              capture_output=True, text=True)
        return json.loads(done.stdout) if done.stdout else {}

    def order(self, *words):
        """Refused is what has waited for a second: asked again."""
        until(lambda: self.ask(*words).get("ok"), "not done: " + " ".join(words))

    def time_until_back(self):
        began = time.monotonic()
        before = None
        while time.monotonic() - began < PATIENCE_S:
            status = self.ask("status")
            count = status.get("odometry", 0)
            if status.get("ports", {}).get("robot") == "up" and before is not None and count > before:
                return time.monotonic() - began
            before = count if status else None
            time.sleep(0.03)
        check(False, f"the robot did not come back: {self.out}")

    def truth_since(self, unix_s):
        """Times, s, and positions."""
        rows = []
        for line in open(self.out / "truth.jsonl"):
            try:
                row = json.loads(line)
            except ValueError:
                continue  # not whole yet
            if "pose" in row and row["t_ns"] * 1e-9 >= unix_s - 0.1:
                rows.append((row["t_ns"] * 1e-9, row["pose"][:2]))
        return rows

    def way_since(self, unix_s):
        """Metres."""
        poses = [pose for _, pose in self.truth_since(unix_s)]
        return sum(math.dist(a, b) for a, b in zip(poses, poses[1:]))

    def simulator_has_reached(self, unix_s):
        rows = self.truth_since(unix_s)
        return bool(rows) and rows[-1][0] > unix_s

    def way_of(self, unix_s, simulated_s):
        """Metres in so much of the simulator's time."""
        until(lambda: self.simulator_has_reached(unix_s + simulated_s), "the simulator stands still")
        return self.way_since(unix_s) - self.way_since(unix_s + simulated_s)

    def heard_last(self, killed):
        """When at the latest the simulated robot has heard what was said before a kill: it looks at its port before it goes on."""
        until(lambda: self.simulator_has_reached(killed), "the simulator stands still")
        return time.time()

    def end(self):
        for process in (self.daemon, self.sim):
            if process and process.poll() is None:
                process.send_signal(signal.SIGKILL)
                process.wait()


def main():
    kills, pulls, seed, late_after_s = (int(value) for value in (sys.argv[2:] + ["3", "3", "1", "3"][len(sys.argv) - 2:]))
    faults, back_s, ways_m = [], {"crash": [], "cable": []}, []
    with tempfile.TemporaryDirectory() as out:
        trial = Trial(sys.argv[1], out, seed)
        try:
            trial.start()
            trial.time_until_back()
            trial.order("drive", "wander")
            for number in range(kills):
                time.sleep(trial.random.uniform(2.0, 6.0))
                was_switched_off = number % 3 == 2
                if was_switched_off:
                    trial.order("drive", "off")
                trial.daemon.send_signal(signal.SIGKILL)
                killed = time.time()
                trial.daemon.wait()
                if number % 2 == 0:
                    late_s = trial.heard_last(killed) - killed
                    moves_on_m = trial.way_of(killed + late_s + STANDS_S, 0.5)
                    way_m = trial.way_since(killed)
                    ways_m.append(way_m)
                    if moves_on_m > 0.004 or way_m > FARTHEST_M + PILOT_M_PER_S * late_s:
                        faults.append("kill %d: %.2f m%s" % (number, way_m, ", and moves on" if moves_on_m > 0.004 else ""))
                else:
                    time.sleep(trial.random.uniform(0.0, 2.0))
                trial.start()
                back_s["crash"].append(trial.time_until_back())
                if was_switched_off:
                    began = trial.heard_last(time.time()) + 1.0 + STANDS_S
                    if trial.way_of(began, 2.0) > 0.01:
                        faults.append("kill %d: an operator had switched it off, and it drives" % number)
                    trial.order("drive", "wander")
            for _ in range(pulls):
                time.sleep(trial.random.uniform(1.0, 4.0))
                trial.cable.pull()
                time.sleep(trial.random.uniform(0.5, 12.0))
                trial.cable.plug()
                back_s["cable"].append(trial.time_until_back())
        finally:
            trial.end()
    for what, times in back_s.items():
        late = sum(value > late_after_s for value in times)
        if times:
            print("%s: %d trials, back after %.2f s at the median, %.2f s at most, %d late" % (
                what, len(times), sorted(times)[len(times) // 2], max(times), late))
        if late > (1.0 - SOON) * len(times):
            faults.append("%s: %d of %d late" % (what, late, len(times)))
    if ways_m:
        print("way after a kill: %.2f m at most of %d" % (max(ways_m), len(ways_m)))
    for fault in faults:
        print("kills: " + fault, file=sys.stderr)
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
