# SPDX-License-Identifier: Apache-2.0
"""The i386 system with its own systemd in a container, at the speed of this machine. Both ports are pseudo-terminals out here, on
cables that can be pulled. Memory limits and allowed devices are not enforced in it, and there are no drivers of real ports."""
import fcntl, os, pathlib, shutil, signal, subprocess, sys, tempfile, time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "system"))
from kills import Cable


class Container:
    name, limits_memory = "container", False
    ports = {"robot": "/mnt/share/robot", "laser": "/mnt/share/laser"}

    def __init__(self, out, links):
        # One at a time: where systemd is not PID 1, the control groups of every container have the same names.
        self.lock = open(out / "container.lock", "w")
        fcntl.flock(self.lock, fcntl.LOCK_EX)
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="container.", dir=out))
        self.share = self.folder / "share"
        self.share.mkdir()
        self.cables = {port: Cable(links / port, self.share / port, self.seen_inside) for port in self.ports}
        self.log = open(self.folder / "log", "wb")
        under_systemd = os.path.isdir("/run/systemd/system")
        self.process = subprocess.Popen(
            ["systemd-nspawn", "--quiet", "--directory=%s" % (out / "root"), "--volatile=overlay", "--register=no", "--console=pipe", "--private-network", "--personality=x86",
             "--machine=deltamap-%d" % os.getpid(), "--bind=%s:/mnt/share" % self.share, "--bind=/dev/pts:/mnt/pts", *([] if under_systemd else ["--keep-unit"]), "--boot"],
            stdin=subprocess.DEVNULL, stdout=self.log, stderr=subprocess.STDOUT)
        self.leader = None

    def begin(self):
        self.leader = self.first_process()

    @staticmethod
    def seen_inside(terminal):
        os.chmod(terminal, 0o666)
        return "/mnt/pts/" + os.path.basename(terminal)

    def first_process(self):
        until = time.monotonic() + 60
        children = pathlib.Path("/proc/%d/task/%d/children" % (self.process.pid, self.process.pid))
        while self.process.poll() is None and time.monotonic() < until:
            for child in children.read_text().split():  # not systemd-nspawn's own, which end
                if pathlib.Path("/proc/%s/comm" % child).read_text().strip() == "systemd":
                    return child
            time.sleep(0.05)
        raise SystemExit("container: does not start: " + (self.folder / "log").read_text(errors="replace")[-2000:])

    def sh(self, command, within_s=120):
        """Exit code and output of a shell command inside."""
        done = subprocess.run(["nsenter", "-t", self.leader, "-m", "-u", "-i", "-n", "-p", "-r", "-w", "--", "/usr/bin/env", "-i", "PATH=/usr/sbin:/usr/bin:/sbin:/bin",
                               "LC_ALL=C", "HOME=/root", "/bin/bash", "-c", command], stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                              timeout=within_s)
        return done.returncode, done.stdout.decode(errors="replace")

    def is_up(self):
        return self.sh("systemctl is-system-running --wait")[1].strip() in ("running", "degraded")

    def pull(self, port):
        self.cables[port].pull()

    def plug(self, port):
        self.cables[port].plug()

    def end(self):
        if self.process.poll() is None and self.leader is None:
            self.process.terminate()
            self.process.wait(20)
        if self.process.poll() is None:
            self.sh("systemctl poweroff --force --force", 20)
            try:
                self.process.wait(20)
            except subprocess.TimeoutExpired:
                os.kill(int(self.leader), signal.SIGKILL)  # its first process: without it nspawn alone would end
                self.process.wait()
        self.log.close()
        shutil.rmtree(self.folder, ignore_errors=True)
        for hierarchy in ("systemd", "unified", ""):  # the empty groups that it leaves where systemd is not PID 1
            for group in ("payload", "supervisor"):
                for folder, _, _ in os.walk("/sys/fs/cgroup/%s/%s" % (hierarchy, group), topdown=False):
                    try:
                        os.rmdir(folder)
                    except OSError:
                        pass
