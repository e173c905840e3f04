#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The service with two USB adapters in a booted Debian 12 (amd64, its own systemd and kernel, in QEMU): plugged in at boot, later, pulled out and
back, in any order, under another number, in another socket. Behind the adapters a simulated robot answers: the daemon is up where both do.
As root, on build/release. usage: adapters.py [--bin FOLDER] [--unit FILE] [--out FILE]"""
import argparse, datetime, json, pathlib, re, shutil, signal, subprocess, sys, tempfile, time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import project
from machine import Machine
from project import ROOT

OUT = ROOT / "build/target/amd64"
WITHIN_S = 180      # an emulated machine beside other work is slow
SETTINGS = "/etc/deltamap/deltamap.yaml"
BOTH = ("robot", "laser")
SOCKETS = {"robot": "1", "laser": "2"}


class Robot(Machine):
    """Both devices behind USB adapters with serial numbers."""
    system = ["qemu-system-x86_64", "-cpu", "max", "-smp", "2"]

    def devices(self):
        return ["-device", "qemu-xhci,id=usb,p2=6,p3=6",
                "-chardev", "serial,id=robot,path=%s" % (self.links / "robot"), "-chardev", "serial,id=laser,path=%s" % (self.links / "laser")]

    def plug(self, port, socket=None):
        self.order("device_add", driver="usb-serial", id=port, chardev=port, bus="usb.0", port=socket or SOCKETS[port], serial="%s-1" % port.upper(), **{"always-plugged": True})

    def switch_off(self):
        self.sh("systemctl --no-block poweroff")
        self.process.wait(300)


class Trials:
    def __init__(self, folder, programs, unit):
        self.folder, self.programs, self.unit_file = folder, programs, unit
        self.rows, self.began = [], time.monotonic()
        self.robot = subprocess.Popen([programs / "deltamap", "sim", "--world", ROOT / "config/scenarios/room.yaml", "--links", folder], stderr=open(folder / "sim.log", "w"))
        while not (folder / "laser").exists():
            if self.robot.poll() is not None:
                raise SystemExit("adapters: " + (folder / "sim.log").read_text())
            time.sleep(0.1)
        self.machine = Robot(OUT, folder)
        self.plugged = set()

    def sh(self, command, within_s=300):
        return self.machine.sh(command, within_s)[1].strip()

    # --- what there is

    def comes(self, holds, within_s=WITHIN_S):
        began = time.monotonic()
        while time.monotonic() - began < within_s:
            if holds():
                return time.monotonic() - began
            time.sleep(0.5)
        return None

    def ports(self):
        code, output = self.machine.sh("deltamap ctl --json status")
        try:
            return json.loads(output)["ports"] if code == 0 else {}
        except (ValueError, KeyError):
            return {}

    def log(self, lines=6):
        return self.sh("journalctl --unit=deltamap --output=cat --no-pager --since=@%d | grep -E '^(.*(robot|laser): )' | tail -n %d" % (self.since, lines))

    def mark(self):
        self.since = int(self.sh("sleep 1; date +%s"))

    def check(self, name, is_met, detail=""):
        detail = str(detail).strip().replace("\n", "; ")
        self.rows.append((name, bool(is_met), detail))
        print("%6.1f s  %-6s %s %s" % (time.monotonic() - self.began, "ok" if is_met else "WRONG", name, detail), flush=True)

    def is_up(self, name):
        after_s = self.comes(lambda: self.ports() == {"robot": "up", "laser": "up"})
        self.check(name, after_s is not None, "" if after_s is not None else self.log() or self.sh("systemctl status --no-pager deltamap | tail -n 3"))

    # --- what is done

    def boot(self, *plugged):
        self.plugged = set(plugged)
        self.machine.switch_on()
        self.machine.begin(plugged)
        self.since = 0

    def plug(self, port, socket=None):
        self.machine.plug(port, socket)
        self.plugged.add(port)
        time.sleep(3)

    def pull_out(self, *ports):
        """Nothing is sent meanwhile: QEMU 7.2 can crash where an adapter goes while bytes come in at it."""
        self.robot.send_signal(signal.SIGSTOP)
        time.sleep(0.5)
        for port in ports:
            self.machine.pull(port)
            self.plugged.discard(port)
        time.sleep(1)
        self.robot.send_signal(signal.SIGCONT)

    def pull(self, *ports):
        self.pull_out(*ports)
        if not self.comes(lambda: all(self.ports().get(port) == "down" for port in ports), 60):
            print("  (not told as down)", flush=True)

    def halted_daemon(self, what):
        """The daemon stands while something is done: it cannot let its ports go, so that their numbers stay taken."""
        self.sh("systemctl kill --signal=STOP deltamap")
        what()
        self.sh("systemctl kill --signal=CONT deltamap")

    def prepare(self):
        """As the package installs, then as docs/install.md says."""
        share = self.machine.share
        for program in ("deltamap", "deltamapd"):
            shutil.copy(self.programs / program, share)
        for file in ("60-deltamap.rules", "deltamap.sysusers", "deltamap.tmpfiles", "restart-delay"):
            shutil.copy(ROOT / "systemd" / file, share)
        shutil.copy(self.unit_file, share / "deltamap.service")
        shutil.copy(ROOT / "config/pioneer.yaml", share / "deltamap.yaml")
        shutil.copytree(ROOT / "config", share / "config")
        self.machine.begin(BOTH)
        self.plugged = set(BOTH)
        self.comes(self.machine.is_up, 900)
        put = "install -D -m %s /mnt/share/%s %s"
        for mode, file, place in (("755", "deltamap", "/usr/bin/deltamap"), ("755", "deltamapd", "/usr/bin/deltamapd"), ("755", "restart-delay", "/usr/libexec/deltamap/restart-delay"),
                                  ("644", "deltamap.service", "/lib/systemd/system/deltamap.service"), ("644", "deltamap.sysusers", "/usr/lib/sysusers.d/deltamap.conf"),
                                  ("644", "deltamap.tmpfiles", "/usr/lib/tmpfiles.d/deltamap.conf"), ("644", "deltamap.yaml", SETTINGS), ("644", "60-deltamap.rules", "/lib/udev/rules.d/60-deltamap.rules")):
            code, output = self.machine.sh(put % (mode, file, place))
            if code:
                raise SystemExit("adapters: " + output)
        self.sh("mkdir -p /usr/share/deltamap && cp -r /mnt/share/config/. /usr/share/deltamap/; systemd-sysusers; systemd-tmpfiles --create; systemctl daemon-reload")
        print(self.sh("runuser -u deltamap -- deltamap sim --world /usr/share/deltamap/scenarios/room.yaml --write-map /var/lib/deltamap/maps/site.yaml"), flush=True)
        path = {port: self.sh("udevadm info /dev/$(basename $(dirname $(grep -l %s-1 /sys/class/tty/ttyUSB*/device/../../serial | sed 's|/device.*||')/x)) | sed -n 's/^E: ID_PATH=//p'" % port.upper()) for port in BOTH}
        print("ID_PATH: %s" % path, flush=True)
        self.sh("sed -e 's|^#\\(.*\\)\"[^\"]*\", SYMLINK+=\"deltamap/robot\"|\\1\"%s\", SYMLINK+=\"deltamap/robot\"|' -e 's|^#\\(.*\\)\"[^\"]*\", SYMLINK+=\"deltamap/laser\"|\\1\"%s\", SYMLINK+=\"deltamap/laser\"|' "
                "/lib/udev/rules.d/60-deltamap.rules >/etc/udev/rules.d/60-deltamap.rules; udevadm control --reload; udevadm trigger; udevadm settle" % (path["robot"], path["laser"]))
        print(self.sh("ls -l /dev/deltamap; uname -r; systemctl --version | head -n 1"), flush=True)
        self.set_ports("/dev/deltamap/robot", "/dev/deltamap/laser")
        self.sh("systemctl enable deltamap; sync")
        self.machine.switch_off()

    def set_ports(self, robot, laser):
        for port, path in (("robot", robot), ("laser", laser)):
            self.sh("sed -i '/^%s:/,/^[a-z]/ s|^  port: [^ ]*|  port: %s|' %s" % (port, path, SETTINGS))

    def restart_without_drivers(self):
        self.sh("systemctl stop deltamap; rmmod ftdi_sio cdc_acm usbserial; grep -c tty[UA] /proc/devices; systemctl start deltamap")

    # --- what is tried

    def at_boot_and_later(self):
        for n in (1, 2, 3):
            self.boot(*(BOTH if n != 2 else reversed(BOTH)))
            self.is_up("both plugged in at boot, boot %d" % n)
            if n < 3:
                self.machine.switch_off()
        for first in BOTH:
            self.pull(first)
            self.plug(first)
            self.is_up("%s pulled out and back" % first)
        for order in (BOTH, BOTH[::-1]):
            self.pull(*BOTH)
            for port in order:
                self.plug(port)
            self.is_up("both pulled out, the %s back first" % order[0])
        self.machine.switch_off()
        for order in (BOTH, BOTH[::-1]):
            self.boot()
            self.comes(lambda: self.ports() == {"robot": "down", "laser": "down"})
            for port in order:
                self.plug(port)
            self.is_up("none at boot, then the %s first" % order[0])
            self.machine.switch_off()
        for first, later in (BOTH, BOTH[::-1]):
            self.boot(first)
            self.comes(lambda: self.ports().get(first) == "up")
            self.plug(later)
            self.is_up("the %s at boot, the %s later" % (first, later))
            if first == "robot":
                self.machine.switch_off()

    def without_drivers(self):
        for order in (BOTH, BOTH[::-1]):
            self.pull(*self.plugged)
            self.restart_without_drivers()
            for port in order:
                self.plug(port)
            self.is_up("started with no driver loaded, then the %s first" % order[0])

    def under_another_number(self):
        def moved(*ports):
            self.pull_out(*ports)
            time.sleep(2)
            for port in ports:
                self.plug(port)

        names = lambda: self.sh("ls /dev/ttyUSB* | tr '\\n' ' '")
        for robot, laser, what in (("/dev/deltamap/robot", "/dev/deltamap/laser", "named by their sockets"), ("/dev/ttyUSB0", "/dev/ttyUSB1", "named by their numbers")):
            self.set_ports(robot, laser)
            self.pull(*self.plugged)
            self.sh("systemctl restart deltamap")
            for port in BOTH:
                self.plug(port)
            self.is_up("%s: both plugged in" % what)
            for ports in (("robot",), ("laser",), ("laser", "robot")):
                self.halted_daemon(lambda: moved(*ports))
                self.is_up("%s: %s back under another number (%s)" % (what, " and ".join(ports), names()))
        self.pull("robot")
        self.plug("robot", "4")
        self.is_up("named by their numbers: the robot's adapter in another socket")
        self.pull(*BOTH)
        for port in ("laser", "robot"):
            self.plug(port)
        self.is_up("named by their numbers: pulled out, back with exchanged numbers (%s)" % names())

    def told(self):
        """What cannot be found is named; what is forbidden is named by its cause."""
        self.set_ports("/dev/ttyUSB0", "/dev/ttyUSB1")
        self.pull(*self.plugged)
        self.sh("systemctl restart deltamap")
        self.mark()
        for port in ("laser", "robot"):
            self.plug(port)
        found = self.comes(lambda: "ports are swapped" in self.log(20), 60)
        self.check("exchanged at the start: told", found is not None, self.log(3))
        self.set_ports("/dev/ttyUSB7", "/dev/ttyUSB0")
        self.mark()
        self.sh("systemctl restart deltamap")
        found = self.comes(lambda: "here is /dev/ttyUSB1" in self.log(20), 60)
        self.check("a port of the settings that is not there: the other one is named", found is not None, self.log(2))
        self.pull("laser", "robot")
        self.sh("systemctl mask --runtime modprobe@usbserial.service modprobe@cdc_acm.service")
        self.set_ports("/dev/deltamap/robot", "/dev/deltamap/laser")
        self.restart_without_drivers()
        self.mark()
        for port in BOTH:
            self.plug(port)
        found = self.comes(lambda: "the driver was loaded after the start of the service" in self.log(20), 60)
        self.check("a driver that came after the start: told", found is not None, self.log(2))
        self.sh("systemctl restart deltamap")
        self.is_up("and a restart mends it")
        self.sh("systemctl unmask --runtime modprobe@usbserial.service modprobe@cdc_acm.service")

    def an_acm_adapter(self):
        """A gadget of the kernel's own as a CDC ACM adapter: nothing answers behind it, but it can be opened."""
        self.set_ports("/dev/ttyACM0", "/dev/deltamap/laser")
        self.restart_without_drivers()
        self.mark()
        self.sh("modprobe dummy_hcd; modprobe g_serial; udevadm settle; ls -l /dev/ttyACM0")
        answer = self.comes(lambda: re.search(r"robot: .*(no bytes came|garbage came)", self.log(20)))
        told = self.log(20)
        self.check("a CDC ACM adapter that comes later may be opened", answer is not None and "not permitted" not in told, told)

    def run(self):
        self.prepare()
        self.at_boot_and_later()
        self.without_drivers()
        self.under_another_number()
        self.told()
        self.an_acm_adapter()

    def end(self):
        try:
            self.machine.end()
        finally:
            self.robot.terminate()
            self.robot.wait()


def main():
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument("--bin", type=pathlib.Path, default=ROOT / "build/release/bin")
    options.add_argument("--unit", type=pathlib.Path, default=ROOT / "systemd/deltamap.service")
    options.add_argument("--out", type=pathlib.Path)
    wanted = options.parse_args()
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(1))  # the machine ends with this
    subprocess.run([ROOT / "tests/target/adapters_image.sh", wanted.bin / "deltamap", wanted.bin / "deltamapd"], check=True)
    began = time.monotonic()
    with tempfile.TemporaryDirectory() as folder:
        trials = Trials(pathlib.Path(folder), wanted.bin, wanted.unit)
        try:
            trials.run()
        finally:
            trials.end()
    met = sum(is_met for _, is_met, _ in trials.rows)
    print("%d of %d" % (met, len(trials.rows)))
    if wanted.out:
        lines = ["Written by `./dev target adapters` (%s, %s, %.0f s)." % (project.provenance(), datetime.date.today(), time.monotonic() - began), "",
                 "The service in a booted Debian 12 (amd64, in QEMU), robot and laser behind USB adapters of the kind FTDI FT232. Met where both devices answer the daemon, or where what "
                 "is wrong is told. **%d of %d.**" % (met, len(trials.rows)), "", "| adapters | | |", "|---|---|---|"]
        lines += ["| %s | %s | %s |" % (name, "yes" if is_met else "**no**", detail.replace("|", "\\|")) for name, is_met, detail in trials.rows]
        project.write_section(wanted.out, "Adapters in a booted machine", lines)
    return 0 if met == len(trials.rows) else 1


if __name__ == "__main__":
    sys.exit(main())
