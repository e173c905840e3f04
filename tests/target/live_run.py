# SPDX-License-Identifier: Apache-2.0
"""A live run of the daemon, of either architecture: robot and laser are simulated behind two pseudo-terminals, in real time."""
import pathlib, shutil, subprocess, sys, time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from project import ROOT

AMD64 = ROOT / "build/release/bin"
I386 = ROOT / "build/deb/i386/source/build/package/bin"
WORLD = ROOT / "config/scenarios/room.yaml"  # small, so that a robot that drives about sees its changes
SETTINGS = {"mapping.persistence_s": 2, "localization.particles.min": 500, "localization.particles.max": 500, "localization.beams": 0}
START = "1,2,0"


def program(architecture, name, under=()):
    """The command that runs a program, under another one such as valgrind; i386 programs in the i386 root."""
    if architecture == "amd64":
        return [*under, str(AMD64 / name)]
    if not (I386 / name).exists():
        raise SystemExit("%s: no such file; ./dev deb i386 builds it" % (I386 / name))
    return [str(ROOT / "packaging/i386.sh"), *under, str(I386 / name)]


class LiveRun:
    """`under`: what the daemon runs under; `beside`: what the simulator runs under; `options`: more of the daemon's."""

    def __init__(self, folder, architecture, seed, under=(), beside=(), options=()):
        self.folder, self.tool, self.processes = folder, AMD64 / "deltamap", []
        shutil.rmtree(folder, ignore_errors=True)
        (folder / "ports").mkdir(parents=True)
        self.recording, self.first_map, self.log = folder / "bytes.pcapng", folder / "m0.yaml", folder / "daemon.log"
        subprocess.run([self.tool, "sim", "--world", WORLD, "--write-map", self.first_map], check=True)
        self.start([*beside, self.tool, "sim", "--world", WORLD, "--links", folder / "ports", "--seed", seed, "--change-every", 10], folder / "sim.log")
        self.wait_for("robot and laser", lambda: (folder / "ports/laser").exists() and (folder / "ports/robot").exists())
        places = {"robot.port": folder / "ports/robot", "laser.port": folder / "ports/laser", "map.file": self.first_map, "map.store": folder / "store.sqlite",
                  "map.newest": folder / "map.yaml", "recording.file": self.recording, "control.socket": folder / "ctl.sock"}
        self.daemon = self.start(program(architecture, "deltamapd", under) + ["--config", ROOT / "config/simulation.yaml", "--initial-pose", START, *options]
                                 + [part for key, value in {**places, **SETTINGS}.items() for part in ("--set", "%s=%s" % (key, value))], self.log)
        self.wait_for("the robot to drive", lambda: self.ctl("drive", "wander").returncode == 0)

    def start(self, command, log):
        self.processes.append(subprocess.Popen([str(part) for part in command], stderr=open(log, "w"), cwd=ROOT))
        return self.processes[-1]

    def ctl(self, *words):
        return subprocess.run([self.tool, "ctl", "--socket", self.folder / "ctl.sock", *words], capture_output=True, text=True)

    def wait_for(self, what, holds, within_s=60):
        until = time.monotonic() + within_s
        while not holds():
            ended = [process for process in self.processes if process.poll() is not None]
            if ended or time.monotonic() > until:
                self.end()
                told = self.log.read_text() if self.log.exists() else (self.folder / "sim.log").read_text()
                raise SystemExit("waited for %s:\n%s" % (what, told[-2000:]))
            time.sleep(0.1)

    def processor_s(self):
        """Each thread's time on a processor, kernel included, by the thread's name."""
        tasks = pathlib.Path("/proc/%d/task" % self.daemon.pid)
        return {(task / "comm").read_text().strip(): int((task / "schedstat").read_text().split()[0]) / 1e9 for task in tasks.iterdir()}

    def peak_mb(self):
        status = pathlib.Path("/proc/%d/status" % self.daemon.pid).read_text()
        return next(int(line.split()[1]) / 1024 for line in status.splitlines() if line.startswith("VmHWM:"))

    def end(self):
        """Stops the daemon in order, so that its files are whole, then the simulator."""
        for process in reversed(self.processes):
            if process.poll() is None:
                process.terminate()
                try:
                    process.wait(60)
                except subprocess.TimeoutExpired:
                    process.kill()
                    process.wait()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.end()


def replay(architecture, recording, first_map, folder, *options, under=()):
    """Replays into a folder; answers what it wrote to standard error."""
    command = program(architecture, "deltamap", under) + ["replay", recording, "--map", first_map, "--out", folder, *options]
    done = subprocess.run([str(part) for part in command], cwd=ROOT, capture_output=True, text=True)
    if done.returncode != 0:
        raise SystemExit("%s\n%s" % (" ".join(map(str, command)), done.stderr[-2000:]))
    return done.stderr


def replay_of(live, architecture, folder, *options, under=()):
    """A replay of what a live run has recorded."""
    settings = [part for key, value in SETTINGS.items() for part in ("--set", "%s=%s" % (key, value))]
    return replay(architecture, live.recording, live.first_map, folder, "--config", ROOT / "config/simulation.yaml", "--initial-pose", START,
                  *settings, *options, under=under)
