# SPDX-License-Identifier: Apache-2.0
"""The netbook as far as QEMU goes: an Atom N270 of two threads, 512 MB, Debian i386. The robot is its second serial port, the laser a USB
adapter that can be pulled out; the other ends of both are the simulator's terminals. Slow: an instruction costs about twenty here."""
import json, os, pathlib, shutil, socket, subprocess, tempfile, time


class Machine:
    name, limits_memory = "machine", True
    ports = {"robot": "/dev/ttyS1", "laser": "/dev/ttyUSB0"}
    system = ["qemu-system-i386", "-cpu", "n270", "-smp", "2,sockets=1,cores=1,threads=2"]

    def __init__(self, out, links):
        self.out, self.links = out, links
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="machine.", dir=out))
        self.share, self.disk = self.folder / "share", self.folder / "disk.qcow2"  # what is written goes there, and with the folder
        self.share.mkdir()
        subprocess.run(["qemu-img", "create", "-q", "-f", "qcow2", "-F", "qcow2", "-b", out / "disk.qcow2", self.disk], check=True)
        self.log = open(self.folder / "qemu.log", "wb")
        self.switch_on()

    def devices(self):
        return ["-chardev", "serial,id=robot,path=%s" % (self.links / "robot"), "-serial", "chardev:robot",
                "-chardev", "serial,id=laser,path=%s" % (self.links / "laser"), "-device", "piix3-usb-uhci,id=usb"]

    def switch_on(self, *more):
        self.bytes = b""
        self.process = subprocess.Popen(
            [*self.system, "-machine", "pc,accel=tcg", "-m", "512", "-nodefaults", "-no-reboot",
             "-display", "none", "-kernel", self.out / "kernel", "-initrd", self.out / "initrd",
             "-append", "root=/dev/vda ro console=ttyS0,115200 quiet systemd.show_status=0 mitigations=off",
             "-drive", "file=%s,if=virtio,cache=unsafe,format=qcow2" % self.disk,
             "-chardev", "file,id=console,path=%s" % (self.folder / "console"), "-serial", "chardev:console",
             *self.devices(), *more, "-device", "virtio-serial-pci", "-chardev", "socket,id=control,path=%s,server=on,wait=off" % (self.folder / "control"),
             "-device", "virtserialport,chardev=control,name=control",
             "-fsdev", "local,id=share,path=%s,security_model=none" % self.share, "-device", "virtio-9p-pci,fsdev=share,mount_tag=share",
             "-device", "virtio-rng-pci", "-qmp", "unix:%s,server=on,wait=off" % (self.folder / "qmp")],
            stdin=subprocess.DEVNULL, stdout=self.log, stderr=subprocess.STDOUT)

    def begin(self, plugged=("laser",)):
        self.orders = self.connected("qmp").makefile("rw")
        self.orders.readline()
        self.order("qmp_capabilities")
        self.control = self.connected("control")
        for port in plugged:
            self.plug(port)
        if self.line(600) != "up":
            raise SystemExit("machine: does not start")
        self.sh("modprobe 9pnet_virtio; mkdir -p /mnt/share; mount -t 9p -o trans=virtio,version=9p2000.L share /mnt/share")

    def connected(self, name):
        end, until = socket.socket(socket.AF_UNIX), time.monotonic() + 20
        while True:
            try:
                end.connect(str(self.folder / name))
                return end
            except OSError:
                if self.process.poll() is not None or time.monotonic() > until:
                    raise SystemExit("machine: " + (self.folder / "qemu.log").read_text(errors="replace")[-2000:])
                time.sleep(0.05)

    def order(self, command, **arguments):
        self.orders.write(json.dumps({"execute": command, "arguments": arguments}) + "\n")
        self.orders.flush()
        while True:
            answer = json.loads(self.orders.readline())
            if "error" in answer:
                raise SystemExit("machine: %s: %s" % (command, answer["error"]["desc"]))
            if "return" in answer:
                return

    def more(self):
        data = self.control.recv(65536)
        if not data:
            raise SystemExit("machine: has ended: " + (self.folder / "console").read_text(errors="replace")[-2000:])
        self.bytes += data

    def line(self, within_s):
        self.control.settimeout(within_s)
        while b"\n" not in self.bytes:
            self.more()
        line, self.bytes = self.bytes.split(b"\n", 1)
        return line.decode()

    def sh(self, command, within_s=300):
        """Exit code and output of a shell command inside."""
        self.control.sendall(command.replace("\n", "; ").encode() + b"\n")
        code, size = map(int, self.line(within_s).split())
        while len(self.bytes) < size:
            self.more()
        output, self.bytes = self.bytes[:size].decode(errors="replace"), self.bytes[size:]
        return code, output

    def is_up(self):
        return self.sh("systemctl is-system-running --wait", 600)[1].strip() in ("running", "degraded")

    def pull(self, port):
        self.order("device_del", id=port)

    def plug(self, port):
        self.order("device_add", driver="usb-serial", id=port, chardev=port, bus="usb.0")

    def end(self):
        if self.process.poll() is None:
            self.process.terminate()
            self.process.wait(60)
        self.log.close()
        shutil.rmtree(self.folder, ignore_errors=True)
