# SPDX-License-Identifier: Apache-2.0
"""How soon the daemon answers a scan where all its threads share one processor, as on a netbook: from the scan's last byte to its pose.
Once as it drives about, and once beside a process that computes without a pause at the priority of the daemon's map thread: a map update
that never ends. The simulator has the other processors."""
import json, os, subprocess, sys, time

from live_run import LiveRun

MOST_MS = 20
CORE = 0
BEFORE_OTHERS = ("nice", "-n", "-15")  # what else runs on this machine is none of the daemon's; among its threads it changes nothing
BUSY = (sys.executable, "-c", "while True: pass")


def others():
    rest = sorted(os.sched_getaffinity(0) - {CORE})
    if not rest or CORE not in os.sched_getaffinity(0):
        raise SystemExit("one_core: needs two processors, one for the daemon alone")
    return ",".join(map(str, rest))


def end(process):
    if process:
        process.kill()
        process.wait()


def answered(folder, seed, seconds, beside_a_busy_one):
    """Of a live run of the i386 daemon: scans, map updates and quantiles of the time to an answer."""
    busy = subprocess.Popen([*BEFORE_OTHERS, "taskset", "-c", str(CORE), *BUSY]) if beside_a_busy_one else None
    try:
        with LiveRun(folder, "i386", seed, under=(*BEFORE_OTHERS, "taskset", "-c", str(CORE)), beside=("taskset", "-c", others()), options=("--out", folder / "run")):
            time.sleep(seconds)
            load, *_ = os.getloadavg()
            end(busy)  # before the daemon stops: what is left of a map update is done then, and may take longer beside it than an end is waited for
    finally:
        end(busy)
    report = json.loads((folder / "run/report.json").read_text())
    return {"scans": report["localized"], "updates": report["revisions_total"] + sum(report["refusals"].values()), "load": load,
            "drops": sum(report["drops"].values()), **{name: report["latency_ms"][name] for name in ("p50", "p99", "p999", "max")}}
