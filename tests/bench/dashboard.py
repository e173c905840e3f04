#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""What the live page costs, measured on a simulated robot in the hall of ./dev demo: ./dev bench dashboard [--quick].
Writes docs/results/dashboard.md, with what ./dev test fuzz has done on this machine (--fuzzed: its file, of another one) and the tests in a browser."""

import argparse
import base64
import json
import os
import pathlib
import socket
import statistics
import struct
import sys
import threading
import time
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "tests/browser"), str(ROOT / "tests/support")]
from browser import Browser  # noqa: E402
from running_daemon import RunningDaemon  # noqa: E402
import project  # noqa: E402

RESULT = ROOT / "docs/results/dashboard.md"
PAGE = ROOT / "daemon/dashboard/page"
PAINTS = 5


class Viewer(threading.Thread):
    """Reads the stream as a browser does, and notes how old each pose is when it comes; or does not read at all."""

    def __init__(self, port, reads=True):
        super().__init__(daemon=True)
        self.reads, self.ages_s, self.came, self.bytes, self.messages, self.ended = reads, [], {}, 0, 0, False
        self.socket = socket.socket()
        if not reads:
            self.socket.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
        self.socket.connect(("127.0.0.1", port))
        key = base64.b64encode(os.urandom(16)).decode()
        self.socket.sendall((f"GET /live HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nConnection: Upgrade\r\nUpgrade: websocket\r\n"
                             f"Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: {key}\r\n\r\n").encode())
        if reads:
            self.stream = self.socket.makefile("rb")
            while self.stream.readline().strip():
                pass
        self.start()

    def run(self):
        if not self.reads:
            return
        try:
            while head := self.stream.read(2):
                length = head[1] & 0x7F
                if length >= 126:
                    length = int.from_bytes(self.stream.read(2 if length == 126 else 8), "big")
                payload = self.stream.read(length)
                self.messages += 1
                self.bytes += 2 + length
                if head[0] & 0x0F == 9:  # a ping
                    self.socket.sendall(b"\x8a" + bytes([0x80 | length]) + b"\0\0\0\0" + payload)
                if payload[:15] == b'{"type":"pose",':
                    now, pose = time.time(), json.loads(payload)
                    self.ages_s.append(now - pose["time"])
                    self.came[pose["scan"]] = now
        except (OSError, struct.error, ValueError):
            pass
        self.ended = True

    def end(self):
        self.socket.close()


class Poses(threading.Thread):
    """Notes when the daemon publishes each pose, as a planner is told on `poses.socket`."""

    def __init__(self, path):
        super().__init__(daemon=True)
        self.came = {}
        self.socket = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
        self.socket.connect(str(path))
        self.start()

    def run(self):
        for line in self.socket.makefile("r"):
            now, told = time.time(), json.loads(line)
            if told["type"] == "pose":
                self.came[told["scan"]] = now


def quantile(values, share):
    ordered = sorted(values)
    return ordered[min(len(ordered) - 1, int(share * len(ordered)))]


def watched(daemon, viewers, seconds):
    """Of so long: processor time of page thread and daemon as a share of one core, and localization's latencies."""
    before, all_before, latencies = daemon.page_thread_cpu_s(), daemon.cpu_s(), []
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        latencies.append(json.loads(daemon.ctl("status", "--json").stdout)["latency_ms"])
        time.sleep(0.25)
    return {"page": (daemon.page_thread_cpu_s() - before) / seconds, "daemon": (daemon.cpu_s() - all_before) / seconds,
            "latency_ms": latencies, "viewers": viewers}


def memory(seconds):
    """Resident memory after the same time without a page, with one, and with a viewer since half of the time."""
    resident = {}
    for name, port in (("off", 0), ("on", None), ("viewer", None)):
        with RunningDaemon(port, change_every_s=1000) as daemon:
            time.sleep(seconds)
            viewer = Viewer(daemon.port) if name == "viewer" else None
            time.sleep(seconds)
            resident[name] = daemon.resident_bytes()
            if viewer:
                viewer.end()
    return resident


def paints(daemon):
    """First contentful paint, and until the map is drawn, ms, each in a new browser."""
    painted, shown = [], []
    for _ in range(PAINTS):
        with Browser() as browser:
            browser.get(daemon.url)
            browser.wait("window.deltamap?.view.tiles.size > 0 && window.deltamap.model.scan")
            shown.append(browser.execute_script("return performance.now()"))
            painted.append(browser.execute_script('return performance.getEntriesByName("first-contentful-paint")[0].startTime'))
    return painted, shown


def percent(share):
    return "%.2f %%" % (100 * share)


def measured(seconds):
    rows = []
    resident = memory(min(30, seconds))
    with RunningDaemon(places={"poses.socket": "poses.sock"}) as daemon:
        poses_told = Poses(daemon.place / "poses.sock")
        alone = watched(daemon, 0, seconds)
        viewer = Viewer(daemon.port)
        time.sleep(2)
        viewer.bytes = viewer.messages = 0
        viewer.ages_s.clear()
        viewer.came.clear()
        one = watched(daemon, 1, seconds)
        rate, poses = viewer.bytes / seconds, len(viewer.ages_s) / seconds
        ages = list(viewer.ages_s)
        ways = [came - poses_told.came[scan] for scan, came in dict(viewer.came).items() if scan in poses_told.came]
        viewer.end()
        many = [Viewer(daemon.port) for _ in range(15)] + [Viewer(daemon.port, reads=False) for _ in range(5)]
        crowd = watched(daemon, 20, seconds)
        for one_of_many in many:
            one_of_many.end()
        painted, shown = paints(daemon)
    page = sum(file.stat().st_size for file in PAGE.iterdir())
    rows.append(("processor, page thread, no viewer", percent(alone["page"]), "0"))
    rows.append(("processor, page thread, one viewer, %.1f poses a second" % poses, percent(one["page"]), "≤ 5 %"))
    rows.append(("processor, whole daemon, no viewer", percent(alone["daemon"]), ""))
    rows.append(("processor, whole daemon, one viewer", percent(one["daemon"]), ""))
    rows.append(("resident memory, page off", "%.1f MB" % (resident["off"] / 1e6), ""))
    rows.append(("resident memory that the page adds, no viewer", "%.1f MB" % ((resident["on"] - resident["off"]) / 1e6), ""))
    rows.append(("resident memory that the page adds, one viewer", "%.1f MB" % ((resident["viewer"] - resident["off"]) / 1e6), "≤ 2 MB"))
    rows.append(("bytes a second to one viewer", "%.1f kB" % (rate / 1e3), ""))
    rows.append(("age of a pose (from the scan's first beam) when it comes, p50 / p99",
                 "%.0f / %.0f ms" % (1e3 * quantile(ages, 0.5), 1e3 * quantile(ages, 0.99)), ""))
    rows.append(("latency of a pose to the page, from its publication (`poses.socket`) on, p50 / p99",
                 "%.0f / %.0f ms" % (1e3 * quantile(ways, 0.5), 1e3 * quantile(ways, 0.99)), "≤ 150 ms p99"))
    rows.append(("localization's latency, no viewer, p50 / p99",
                 "%.2f / %.2f ms" % (quantile(alone["latency_ms"], 0.5), quantile(alone["latency_ms"], 0.99)), ""))
    rows.append(("localization's latency, 20 viewers of which 5 do not read, p50 / p99",
                 "%.2f / %.2f ms" % (quantile(crowd["latency_ms"], 0.5), quantile(crowd["latency_ms"], 0.99)), "as without"))
    rows.append(("processor, page thread, these 20 viewers", percent(crowd["page"]), ""))
    rows.append(("size of the page, all its files", "%.1f kB" % (page / 1e3), "≤ 300 kB"))
    rows.append(("first paint on loopback, median of %d" % PAINTS, "%.0f ms" % statistics.median(painted), "≤ 1000 ms"))
    rows.append(("map and scan shown, median of %d" % PAINTS, "%.0f ms" % statistics.median(shown), "≤ 2000 ms"))
    return rows


def fuzzed(file):
    """One row of what the fuzzer has told, a JSON line a run."""
    runs = [json.loads(line) for line in file.read_text().splitlines()] if file.exists() else []
    if not runs:
        return ("damaged HTTP and WebSocket input, under the sanitizers", "none on this machine", "1 h")
    failed = sum(not run["holds"] for run in runs)
    return ("damaged HTTP and WebSocket input, under the sanitizers", "%.2f h, %d cases; %s" % (
        sum(run["seconds"] for run in runs) / 3600, sum(run["cases"] for run in runs), "%d runs failed" % failed if failed else "all held"), "1 h")


def browser_tests():
    """The names of all tests in a browser, as sentences, by file."""
    by_file = {}
    waiting = list(unittest.defaultTestLoader.discover(str(ROOT / "tests/browser"), "*_test.py"))
    while waiting:
        one = waiting.pop(0)
        if isinstance(one, unittest.TestSuite):
            waiting[:0] = list(one)
        else:
            file, _, name = one.id().split(".")
            by_file.setdefault(file, []).append(name.removeprefix("test_").replace("_", " "))
    return by_file


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--quick", action="store_true", help="10 s in place of 60 s for each figure")
    parser.add_argument("--fuzzed", type=pathlib.Path, default=ROOT / "build/asan/page_fuzz.jsonl", help="what ./dev test fuzz has told")
    arguments = parser.parse_args()
    seconds = 10 if arguments.quick else 60
    rows = measured(seconds) + [fuzzed(arguments.fuzzed)]
    lines = ["# What the live page costs", "",
             "Written by `./dev bench dashboard`: the hall of `./dev demo` (741 × 741 cells, 181 beams, 9.4 scans a second), %d s for each figure;" % seconds,
             "%s; load of the machine while it was measured: %.1f. Percentages are of one processor." % (project.provenance(), os.getloadavg()[1]), "",
             "| figure | measured | wanted |", "|---|---|---|"]
    lines += ["| %s | %s | %s |" % row for row in rows]
    lines += ["", "## Tests in a browser", "", "`./dev test browser`, in Chromium:", ""]
    lines += ["- `%s`: %s" % (file, "; ".join(names)) for file, names in browser_tests().items()]
    RESULT.write_text("\n".join(lines) + "\n")
    print("\n".join(lines))


if __name__ == "__main__":
    main()
