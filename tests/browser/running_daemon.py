# SPDX-License-Identifier: Apache-2.0
"""A simulated robot in the hall of ./dev demo, and the daemon that serves its live page."""

import json
import pathlib
import socket
import subprocess
import tempfile
import time
import urllib.request

ROOT = pathlib.Path(__file__).resolve().parents[2]
BIN = ROOT / "build/release/bin"
WORLD = ROOT / "config/scenarios/demo.yaml"


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


class RunningDaemon:
    """Simulator and daemon, until the `with` block ends. `port` 0: without a page. `token`: asked of every viewer. `settings`: more of them.
    `places`: settings that name a file in the daemon's folder. `files`: what stands there at the start, by name."""

    def __init__(self, port=None, change_every_s=15, token=None, settings=None, places=None, files=None):
        self.places = places or {}
        self.settings = settings or {}
        self.port = free_port() if port is None else port
        self.url = f"http://127.0.0.1:{self.port}/"
        self.folder = tempfile.TemporaryDirectory(prefix="deltamap-page-")
        self.place = pathlib.Path(self.folder.name)
        for name, text in (files or {}).items():
            (self.place / name).write_text(text)
        self.token = token
        if token:
            (self.place / "token").write_text(token + "\n")
            (self.place / "token").chmod(0o600)
        subprocess.run([BIN / "deltamap", "sim", "--world", WORLD, "--write-map", self.place / "m0.yaml"], check=True, capture_output=True)
        self.log = (self.place / "log").open("w")
        self.simulator = subprocess.Popen([BIN / "deltamap", "sim", "--world", WORLD, "--links", self.place, "--seed", "1",
                                           "--change-every", str(change_every_s), "--truth", self.place / "truth.jsonl"],
                                          stderr=self.log, stdout=self.log)
        self._until(lambda: (self.place / "robot").exists() and (self.place / "laser").exists())
        try:
            self.start()
        except BaseException:
            self.__exit__()
            raise

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.stop()
        self.simulator.terminate()
        self.simulator.wait(20)
        self.log.close()
        self.folder.cleanup()

    def _until(self, condition, patience_s=20):
        give_up_at = time.monotonic() + patience_s
        while not condition():
            if time.monotonic() > give_up_at:
                raise RuntimeError((self.place / "log").read_text()[-2000:])
            time.sleep(0.05)

    def start(self):
        places = {"robot.port": "robot", "laser.port": "laser", "map.file": "m0.yaml", "map.store": "store.sqlite", "control.socket": "ctl.sock", **self.places}
        command = [BIN / "deltamapd", "--config", ROOT / "config/simulation.yaml", "--set", f"dashboard.port={self.port}"]
        if self.token:
            places["dashboard.token_file"] = "token"
        for key, name in places.items():
            command += ["--set", f"{key}={self.place / name}"]
        for key, value in self.settings.items():
            command += ["--set", f"{key}={value}"]
        self.daemon = subprocess.Popen(command, stderr=self.log, stdout=self.log, cwd=ROOT)
        self._until(lambda: self.ctl("drive", "wander").returncode == 0)
        self._until(lambda: self.status()["localized"] > 5)

    def stop(self):
        self.daemon.terminate()
        self.daemon.wait(60)

    def ctl(self, *words):
        return subprocess.run([BIN / "deltamap", "ctl", "--socket", self.place / "ctl.sock", *words], capture_output=True, text=True)

    def changes(self):
        """What the simulator has changed so far."""
        lines = (self.place / "truth.jsonl").read_text().splitlines()
        return [json.loads(line)["change"] for line in lines if '"change"' in line and line.endswith("}")]

    def get(self, path):
        headers = {"Authorization": f"Bearer {self.token}"} if self.token else {}
        with urllib.request.urlopen(urllib.request.Request(self.url + path.lstrip("/"), headers=headers), timeout=10) as answer:
            return answer.read()

    def status(self):
        return json.loads(self.ctl("status", "--json").stdout)

    def page(self):
        """Where a browser begins."""
        return self.url + (f"?token={self.token}" if self.token else "")

    def resident_bytes(self):
        return int(pathlib.Path(f"/proc/{self.daemon.pid}/statm").read_text().split()[1]) * 4096

    def page_thread_cpu_s(self):
        """Processor time of the page's thread, in clock ticks of 10 ms."""
        for task in pathlib.Path(f"/proc/{self.daemon.pid}/task").iterdir():
            if (task / "comm").read_text().strip() == "page":
                fields = (task / "stat").read_text().rsplit(")", 1)[1].split()
                return (int(fields[11]) + int(fields[12])) / 100
        return 0.0

    def cpu_s(self):
        fields = pathlib.Path(f"/proc/{self.daemon.pid}/stat").read_text().rsplit(")", 1)[1].split()
        return (int(fields[11]) + int(fields[12])) / 100
