#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Real daemon, simulated robot on pseudo-terminals, real time: kills it at random moments of the life of an incident, and starts it
again. What it had heard is then an incident that replays, or the log tells why it is none.
usage: incident_kills.py FOLDER-OF-PROGRAMS [KILLS] [SEED]"""
import json, signal, subprocess, sys, tempfile, time

from kills import Trial
from live_trial import check, until

LOST_S = 1.5        # what a daemon may not yet have handed to the kernel, on a machine that is busy
LONGEST_S = 45.0    # more than an incident lives
ENDED = "ended without a word"


class KeepingTrial(Trial):
    def __init__(self, bin, out, seed):
        super().__init__(bin, out, seed)
        self.folder = self.out / "incidents"
        self.settings["incidents.folder"] = self.folder

    def tool(self, *words):
        return subprocess.run([self.bin / "deltamap", "incident", *words, "--folder", self.folder], capture_output=True, text=True)

    def shown(self):
        """Every incident, as its incident.json tells it."""
        return [json.loads(self.tool("show", one["name"], "--json").stdout) for one in json.loads(self.tool("list", "--json").stdout)]

    def killed_once(self, fault):
        """Starts it, lets it keep a moment or not, kills it, and looks at what the next start makes of it."""
        lived_s = self.random.uniform(0.5, 8.0) if self.random.random() < 0.7 else self.random.uniform(8.0, LONGEST_S)
        marks_after_s = self.random.uniform(0.0, 1.3 * lived_s)
        began = time.time()
        self.start()
        if marks_after_s < lived_s:
            time.sleep(marks_after_s)
            self.ask("mark", "trial")
        time.sleep(max(0.0, began + lived_s - time.time()))
        self.daemon.send_signal(signal.SIGKILL)
        killed = time.time()
        self.daemon.wait()
        told_before = (self.out / "daemon.log").read_text().count(ENDED)
        self.start()
        self.time_until_back()
        until(lambda: not list(self.folder.glob(".left-*")), "what was left is not worked off")
        self.daemon.send_signal(signal.SIGTERM)
        check(self.daemon.wait(60) == 0, "it does not end")
        told = (self.out / "daemon.log").read_text().count(ENDED) - told_before
        ends = [(one, event) for one in self.shown() for event in one["events"] if event["kind"] == "daemon-ended" and began < event["time_ns"] * 1e-9 < killed + 0.1]
        if len(ends) != 1:
            return None if told else fault("after %.1f s: %d incidents, and nothing is told" % (lived_s, len(ends)))
        incident, event = ends[0]
        late_s = killed - event["time_ns"] * 1e-9
        replayed = self.tool("replay", incident["name"])
        if late_s > LOST_S:
            fault("after %.1f s: the last %.1f s are lost" % (lived_s, late_s))
        if incident["to_ns"] is None or replayed.returncode != 0 or "cut short" in replayed.stderr:
            fault("after %.1f s: %s does not replay: %s" % (lived_s, incident["name"], replayed.stderr[-400:]))
        return {"late_s": late_s, "marked": len(incident["events"]) > 1, "lived_s": lived_s}


def main():
    kills, seed = (int(value) for value in (sys.argv[2:] + ["6", "1"][len(sys.argv) - 2:]))
    faults, kept = [], []
    with tempfile.TemporaryDirectory() as out:
        trial = KeepingTrial(sys.argv[1], out, seed)
        try:
            for _ in range(kills):
                kept.append(trial.killed_once(faults.append))
        finally:
            trial.end()
    whole = [one for one in kept if one]
    print("%d kills: %d incidents that replay, %d of them marked before; %d told and not there; lost %.2f s at most" % (
        kills, len(whole), sum(one["marked"] for one in whole), kills - len(whole), max([one["late_s"] for one in whole], default=0.0)))
    for fault in faults:
        print("incident_kills: " + fault, file=sys.stderr)
    return 1 if faults or len(whole) < 0.7 * kills else 0


if __name__ == "__main__":
    sys.exit(main())
