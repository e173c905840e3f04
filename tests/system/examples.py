#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The programs and set-ups in examples/, against a daemon with a simulated robot: they print what the daemon serves, and no panel or
scrape job names what it does not. usage: examples.py FOLDER-OF-PROGRAMS"""

import json
import re
import subprocess
import time
import urllib.request

from live_trial import PATIENCE_S, ROOT, check, free_port, main, set_options, until

WORLD = ROOT / "config/scenarios/room.yaml"
START = (1.0, 2.0)  # the room's robot


def read(address):
    try:
        return urllib.request.urlopen(address, timeout=PATIENCE_S).read().decode()
    except OSError:  # nobody listens yet
        return None


def check_pose_stream(place):
    """It says where the robot stands once a planner may drive by that, and ends with the daemon."""
    client = subprocess.Popen([ROOT / "examples/pose_stream/pose_client.py", place / "poses.sock"], stdout=subprocess.PIPE, text=True)
    give_up_at = time.monotonic() + PATIENCE_S
    for line in client.stdout:
        if line.strip() != "stand":
            break
        check(time.monotonic() < give_up_at, "nobody may drive by the pose")
    else:
        check(False, "pose_client.py tells no pose")
    told, x, y, heading = map(float, line.split())
    check(0 < told <= time.time(), f"a pose of {told}")
    check(abs(x - START[0]) < 0.5 and abs(y - START[1]) < 0.5 and abs(heading) < 0.5, f"the robot stands at {START}: {line}")
    return client


def check_no_daemon(place):
    """It says in a line that nobody listens there."""
    client = subprocess.run([ROOT / "examples/pose_stream/pose_client.py", place / "nobody.sock"], capture_output=True, text=True)
    check(client.returncode == 1 and client.stderr.startswith(f"{place}/nobody.sock: ") and "poses.socket" in client.stderr, client.stderr)


def check_map(page, place):
    """The page and the file of `map.newest` are the same map; the robot stands on free floor, and outside nothing is known."""
    program = ROOT / "examples/planner_map/read_map.py"
    point = f"{START[0]},{START[1]}"
    told = {name: subprocess.run([program, source, point], check=True, capture_output=True, text=True).stdout.splitlines()
            for name, source in (("page", page), ("file", place / "newest.yaml"))}
    check(told["page"][0] == "revision 0" and told["page"][1:] == told["file"], f"two maps: {told}")
    check(told["file"][-1] == "free", f"the robot stands on {told['file'][-1]}")
    outside = subprocess.run([program, place / "newest.yaml", "-1000,0"], check=True, capture_output=True, text=True).stdout
    check(outside.splitlines()[-1] == "unknown", f"outside the map it is {outside}")


def check_metrics(page):
    """Each metric and label of the dashboard is served, and the scrape job asks at the delivered port."""
    served = read(f"{page}/metrics")
    dashboard = json.loads((ROOT / "examples/prometheus/dashboard.json").read_text())
    asked = [target["expr"] for panel in dashboard["panels"] for target in panel["targets"]]
    asked.append(dashboard["templating"]["list"][1]["definition"])
    for expression in asked:
        names = re.findall(r"deltamap_\w+", expression)
        check(names, f"no metric in {expression}")
        for name in names:
            check(re.search(rf"^{name}(\{{[^}}]*\}})? \S+$", served, re.M), f"{name} is not served")
    for panel in dashboard["panels"]:
        for target in panel["targets"]:
            for label in re.findall(r"{{(\w+)}}", target["legendFormat"]):
                metric = re.search(r"deltamap_\w+", target["expr"]).group()
                check(re.search(rf"^{metric}{{[^}}]*\b{label}=", served, re.M), f"{metric} has no label {label}")
    check('"127.0.0.1:8484"' in (ROOT / "examples/prometheus/prometheus.yml").read_text(), "another port in prometheus.yml")


def run(bin_folder, place, log):
    subprocess.run([bin_folder / "deltamap", "sim", "--world", WORLD, "--write-map", place / "m0.yaml"], check=True, stdout=log, stderr=log)
    processes = [subprocess.Popen([bin_folder / "deltamap", "sim", "--world", WORLD, "--links", place], stdout=log, stderr=log)]
    port = free_port()
    page = f"http://127.0.0.1:{port}"
    settings = {"robot.port": place / "robot", "laser.port": place / "laser", "map.file": place / "m0.yaml", "map.store": "", "map.newest": place / "newest.yaml",
                "recording.file": "", "control.socket": "", "poses.socket": place / "poses.sock", "dashboard.port": port, "dashboard.control": "false",
                "navigation.mode": "off", "mapping.enabled": "false"}
    try:
        until(lambda: (place / "robot").exists() and (place / "laser").exists(), "no simulator")
        processes.append(subprocess.Popen([bin_folder / "deltamapd", "--config", ROOT / "config/simulation.yaml", "--initial-pose", f"{START[0]},{START[1]},0", *set_options(settings)],
                                          stdout=log, stderr=log))
        until(lambda: (place / "poses.sock").exists() and (place / "newest.yaml").exists() and read(f"{page}/metrics") is not None, "no daemon")
        processes.append(check_pose_stream(place))
        check_no_daemon(place)
        check_map(page, place)
        check_metrics(page)
        processes[1].terminate()
        check(processes[1].wait(PATIENCE_S) == 0, "the daemon did not end well")
        processes[2].stdout.read()
        check(processes[2].wait(PATIENCE_S) == 0, "pose_client.py does not end with the daemon")
    finally:
        for process in processes:
            process.kill()
            process.wait()


if __name__ == "__main__":
    main(run)
