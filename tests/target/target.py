#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The i386 package under its own systemd, with both serial ports played from outside by a simulated robot: installs, starts, tracks, is killed
by watchdog, crash and memory limit, loses a port; each time it is back by itself. As root, on build/deb/i386.
usage: target.py container|machine [--out FILE]    container: at this machine's speed; machine: an emulated Atom N270 of 512 MB"""
import argparse, datetime, json, math, pathlib, re, subprocess, sys, tempfile, time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import project
from container import Container
from machine import Machine
from project import ROOT

OUT = ROOT / "build/target"
TOOL = ROOT / "build/release/bin/deltamap"
PLACES = {"container": (Container, "in a container, at the speed of this machine"), "machine": (Machine, "on an emulated Atom N270 with 512 MB")}
OFF_M = 0.3      # 0.5 m/s for what a status takes on its way, and the tolerance
WORLD = "/usr/share/deltamap/scenarios/room.yaml"


class Trial:
    def __init__(self, place, folder):
        self.folder, self.checks, self.wrong, self.began = folder, [], 0, time.monotonic()
        self.robot = subprocess.Popen([TOOL, "sim", "--world", ROOT / "config/scenarios/room.yaml", "--links", folder, "--truth", folder / "truth.jsonl"],
                                      stderr=open(folder / "sim.log", "w"))
        while not (folder / "laser").exists():
            if self.robot.poll() is not None:
                raise SystemExit("target: " + (folder / "sim.log").read_text())
            time.sleep(0.1)
        self.target = place(OUT, folder)

    def check(self, name, is_met, detail=""):
        self.checks.append((name, bool(is_met), str(detail).strip()))
        self.wrong += not is_met
        print("%6.1f s  %-6s %s %s" % (time.monotonic() - self.began, "ok" if is_met else "WRONG", name, str(detail).strip()), flush=True)

    def sh(self, command):
        return self.target.sh(command)[1].strip()

    def status(self):
        code, output = self.target.sh("deltamap ctl --json status")
        try:
            return json.loads(output) if code == 0 else {}
        except ValueError:
            return {}

    def unit(self, what):
        return self.sh("systemctl show deltamap --property=%s --value" % what)

    def comes(self, holds, within_s):
        """Seconds until it holds, or nothing."""
        began = time.monotonic()
        while time.monotonic() - began < within_s:
            if holds():
                return time.monotonic() - began
            time.sleep(0.3)
        return None

    def off_m(self):
        """How far the pose is from where the simulator has the robot."""
        lines = (self.folder / "truth.jsonl").read_text().split("\n")[-20:-1]  # whole ones; changes are told among the poses
        truth = [told["pose"] for told in map(json.loads, lines) if "pose" in told][-1]
        pose = self.status().get("pose", {})
        return math.hypot(pose.get("x_m", 99) - truth[0], pose.get("y_m", 99) - truth[1])

    def finds_itself(self):
        """Its estimate is right; a robot that stands may not believe it before it is moved."""
        after_s = self.comes(lambda: self.off_m() <= OFF_M, 120)
        off_m, state = self.off_m(), self.status().get("state")
        self.check("and finds itself, within %.1f m" % OFF_M, after_s is not None, "%.1f s later (%s)" % (after_s, state) if after_s is not None else "%.2f m off" % off_m)

    def comes_back(self, name, pid, result, within_s):
        """Another process than `pid` localizes, and the journal tells why."""
        after_s = self.comes(lambda: self.unit("MainPID") not in (pid, "0") and self.status().get("localized", 0) > 5, within_s)
        told = self.sh("journalctl --unit=deltamap --output=cat | grep -cE \"Failed with result '%s'\"" % result)
        self.check(name, after_s is not None and told not in ("", "0"), "localizes %.1f s later" % after_s if after_s is not None else self.sh("systemctl status --no-pager deltamap"))

    # --- what is tried

    def install(self, deb):
        (self.target.share / "deltamap.deb").write_bytes(deb.read_bytes())
        code, output = self.target.sh("dpkg --install /mnt/share/deltamap.deb")
        self.check("installs", code == 0, self.sh("deltamapd --version") if code == 0 else output[-500:])
        self.check("installing starts nothing and enables nothing", self.sh("systemctl is-active deltamap; systemctl is-enabled deltamap").split() == ["inactive", "disabled"])
        settings = "/etc/deltamap/deltamap.yaml"
        self.sh("sed -i 's|/dev/ttyUSB0|PORT_OF_ROBOT|; s|/dev/ttyUSB1|%s|; s|PORT_OF_ROBOT|%s|; s|mode: off .*|mode: wander|' %s" %
                (self.target.ports["laser"], self.target.ports["robot"], settings))
        self.sh("printf 'recording:\\n  file: /var/lib/deltamap/recordings/bytes.pcapng\\n' >>%s" % settings)
        self.sh("install -d /run/systemd/system/deltamap.service.d; printf '[Service]\\nDeviceAllow=char-pts rw\\n' >/run/systemd/system/deltamap.service.d/ports.conf; systemctl daemon-reload")
        code, output = self.target.sh("runuser -u deltamap -- deltamap sim --world %s --write-map /var/lib/deltamap/maps/site.yaml" % WORLD)
        self.check("writes a map of the simulated room", code == 0, output[-300:])

    def start(self):
        began = time.monotonic()
        code, output = self.target.sh("systemctl start deltamap")
        self.check("starts: systemd is told that it is ready", code == 0 and self.unit("ActiveState") == "active", "%.1f s" % (time.monotonic() - began) if code == 0 else output)
        exposure = re.search(r"exposure level for \S+: (\d+\.\d)", self.sh("systemd-analyze security --no-pager deltamap 2>&1 | tail -n 1"))
        self.check("exposure at most 1.5", exposure and float(exposure.group(1)) <= 1.5, exposure.group(1) if exposure else "not told")

    def track(self):
        def ports_answer():  # a laser is up before its first scan has come
            status = self.status()
            return set(status.get("ports", {"": ""}).values()) == {"up"} and status.get("localized", 0) > 0

        self.check("both ports answer", self.comes(ports_answer, 90) is not None)
        code, output = self.target.sh("deltamap ctl relocalize 1,2,0")
        is_taken = code == 0 or "not answered yet" in output  # a slow machine does it all the same
        self.check("tracks once a person has said where it stands", is_taken and self.comes(lambda: self.status().get("state") == "tracking", 60) is not None, "" if code == 0 else output)
        self.check("drives about when a person says so", self.target.sh("deltamap ctl drive wander")[0] == 0)
        before, began = self.status().get("localized", 0), time.monotonic()
        time.sleep(20)
        status = self.status()
        per_s = (status.get("localized", 0) - before) / (time.monotonic() - began)
        self.check("localizes at least 9 scans a second", per_s >= 9.0, "%.1f a second, newest pose %.1f ms behind its scan" % (per_s, status.get("latency_ms", -1)))
        off_m = self.off_m()
        self.check("is where the simulator has it, within %.1f m" % OFF_M, off_m <= OFF_M, "%.2f m, on its way" % off_m)
        memory = re.search(r"VmHWM:\s*(\d+)", self.sh("cat /proc/$(systemctl show deltamap --property=MainPID --value)/status"))
        self.check("peak of resident memory at most 28 MB", memory and int(memory.group(1)) <= 28 * 1024, "%.1f MB" % (int(memory.group(1)) / 1024) if memory else "")

    def starve_the_watchdog(self):
        pid = self.unit("MainPID")
        self.sh("kill -STOP %s" % pid)
        self.comes_back("a daemon that stands is ended by the watchdog and is back", pid, "watchdog", 120)
        self.finds_itself()

    def crash(self):
        pid = self.unit("MainPID")
        self.sh("kill -SEGV %s" % pid)
        self.comes_back("back after a crash", pid, "(core-dump|signal)", 120)
        self.finds_itself()
        told = self.sh("journalctl --output=cat | grep -c 'failed 2 times in a row: the next start waits for another 2 s'")
        self.check("the second failure in a row waits longer", told == "1")

    def run_out_of_memory(self):
        pid = self.unit("MainPID")
        self.sh("systemctl set-property --runtime deltamap MemoryHigh=infinity MemoryMax=2M")  # less than its heap: what is mapped from files can be dropped
        self.comes(lambda: self.unit("MainPID") != pid, 60)
        self.sh("systemctl set-property --runtime deltamap MemoryHigh=96M MemoryMax=128M")
        self.comes_back("ended by the memory limit, and back", pid, "oom-kill", 180)

    def lose_a_port(self):
        pid = self.unit("MainPID")
        self.target.pull("laser")
        self.check("a pulled laser is told of, the daemon goes on", self.comes(lambda: self.status().get("ports", {}).get("laser") == "down", 60) is not None and self.unit("MainPID") == pid)
        self.target.plug("laser")
        after_s = self.comes(lambda: self.status().get("ports", {}).get("laser") == "up", 120)
        localized = self.status().get("localized", 0)
        self.check("plugged in again it localizes", after_s is not None and self.comes(lambda: self.status().get("localized", 0) > localized + 10, 60) is not None and self.unit("MainPID") == pid,
                   "%.1f s later" % after_s if after_s is not None else "")

    def stop(self):
        code, output = self.target.sh("systemctl stop deltamap")
        self.check("stops in order", code == 0 and self.unit("Result") == "success", output or self.unit("Result"))
        self.check("leaves map, store and recording", self.target.sh("cd /var/lib/deltamap && test -s map.pgm -a -s map_store.sqlite -a -s recordings/bytes.pcapng")[0] == 0)

    def run(self, deb):
        self.target.begin()
        self.check("the system comes up", self.comes(self.target.is_up, 600) is not None, self.sh("uname -m"))
        self.install(deb)
        self.start()
        self.track()
        self.starve_the_watchdog()
        self.crash()
        if self.target.limits_memory:
            self.run_out_of_memory()
        self.lose_a_port()
        self.stop()

    def end(self):
        try:
            self.target.end()
        finally:
            self.robot.terminate()
            self.robot.wait()


def section(checks, where, how, seconds):
    lines = ["Written by `./dev target %s` (%s, %s, %.0f s)." % (where, project.provenance(), datetime.date.today(), seconds), "",
             "The i386 package under its own systemd %s, both serial ports played from outside by a simulated robot." % how, "", "| what | | |", "|---|---|---|"]
    return lines + ["| %s | %s | %s |" % (name, "yes" if is_met else "**no**", detail.splitlines()[0].replace("|", "\\|") if detail else "") for name, is_met, detail in checks]


def main():
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument("where", choices=PLACES)
    options.add_argument("--out", type=pathlib.Path)
    wanted = options.parse_args()
    debs = [deb for deb in (ROOT / "build/deb/i386").glob("deltamap_*_i386.deb")]
    if len(debs) != 1:
        raise SystemExit("target: %d packages in build/deb/i386; ./dev deb i386 makes one" % len(debs))
    place, how = PLACES[wanted.where]
    subprocess.run([ROOT / "tests/target/image.sh", debs[0], *(["disk"] if place is Machine else [])], check=True)
    began = time.monotonic()
    with tempfile.TemporaryDirectory() as folder:
        trial = Trial(place, pathlib.Path(folder))
        try:
            trial.run(debs[0])
        finally:
            trial.end()
    lines = section(trial.checks, wanted.where, how, time.monotonic() - began)
    (project.write_section(wanted.out, "The package " + how, lines) if wanted.out else print("\n".join(lines)))
    return 1 if trial.wrong else 0


if __name__ == "__main__":
    sys.exit(main())
