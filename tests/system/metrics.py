#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""What a daemon tells Prometheus, held against Prometheus's own checker (promtool, of Debian's package prometheus, which
./dev test fetches into build/tools). usage: metrics.py FOLDER-OF-PROGRAMS; exit code 77 where there is no promtool"""

import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import time
import urllib.request

from live_trial import PATIENCE_S, ROOT, free_port, set_options


def read_metrics(port, daemon):
    give_up_at = time.monotonic() + PATIENCE_S
    while time.monotonic() < give_up_at and daemon.poll() is None:
        try:
            return urllib.request.urlopen(f"http://127.0.0.1:{port}/metrics", timeout=PATIENCE_S).read()
        except OSError:  # nobody listens yet, or nobody answers
            time.sleep(0.1)
    raise SystemExit("metrics: the daemon has answered nothing")


def main():
    bin_folder = pathlib.Path(sys.argv[1])
    promtool = shutil.which("promtool", path=f"{os.environ['PATH']}:{ROOT / 'build/tools'}")
    if promtool is None:
        print("SKIPPED: there is no promtool (Debian's package prometheus): nobody has checked /metrics", file=sys.stderr)
        raise SystemExit(77)
    with tempfile.TemporaryDirectory(prefix="deltamap-metrics-") as folder:
        place = pathlib.Path(folder)
        world = ROOT / "config/scenarios/demo.yaml"
        subprocess.run([bin_folder / "deltamap", "sim", "--world", world, "--write-map", place / "m0.yaml"], check=True, capture_output=True)
        port = free_port()
        own = {"robot.port": place / "no_robot", "laser.port": place / "no_laser", "map.file": place / "m0.yaml", "map.store": place / "store.sqlite",
               "control.socket": place / "ctl.sock", "dashboard.port": port}
        command = [bin_folder / "deltamapd", "--config", ROOT / "config/simulation.yaml", *set_options(own)]
        with (place / "log").open("w") as log:
            daemon = subprocess.Popen(command, stdout=log, stderr=log, cwd=ROOT)
            try:
                metrics = read_metrics(port, daemon)
            finally:
                daemon.terminate()
                daemon.wait(PATIENCE_S)
        checked = subprocess.run([promtool, "check", "metrics"], input=metrics, capture_output=True)
        # promtool tells mistakes and bad style on standard error; bad style alone ends with 3.
        if checked.returncode or checked.stderr or checked.stdout:
            sys.stderr.write((checked.stdout + checked.stderr).decode())
            raise SystemExit(f"metrics: promtool ends with {checked.returncode}")
        broken = metrics.replace(b"# TYPE deltamap_scans_total counter\n", b"# TYPE deltamap_scans_total gague\n")
        assert broken != metrics, "the counter of scans is told"
        if subprocess.run([promtool, "check", "metrics"], input=broken, capture_output=True).returncode == 0:
            raise SystemExit("metrics: promtool accepts what is broken: this test could not fail")


main()
