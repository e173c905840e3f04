#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""A recording of the simulated robot goes through the real editcap, mergecap, tshark and reordercap, and what comes out is replayed: either
the replay is that of the recording as it was written, or it is told why it is not. Needs wireshark-common and tshark; called by hand.
usage: edited.py [--bin FOLDER] [--seconds N] [--keep FOLDER] [--out FILE]"""
import argparse, datetime, hashlib, json, os, pathlib, shlex, shutil, struct, subprocess, sys, tempfile, time

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests/support"))
import project

WORLD = ROOT / "config/scenarios/room.yaml"
SETTINGS = ["--set", "localization.initial_pose=[1,2,0]", "--set", "dashboard.port=0", "--set", "dashboard.control=false"]


def fail(why):
    raise SystemExit("edited: " + why)


class Recorded:
    """One live run with orders of an operator in it."""

    def __init__(self, programs, folder, seconds):
        self.programs, self.folder = programs, folder
        self.tool = programs / "deltamap"
        subprocess.run([self.tool, "sim", "--world", WORLD, "--write-map", folder / "m0.yaml"], check=True, capture_output=True)
        robot = subprocess.Popen([self.tool, "sim", "--world", WORLD, "--links", folder], stderr=open(folder / "sim.log", "w"))
        try:
            while not (folder / "laser").exists():
                time.sleep(0.1)
            self.live(seconds)
        finally:
            robot.terminate()
            robot.wait()

    def live(self, seconds):
        daemon = subprocess.Popen(
            [self.programs / "deltamapd", "--config", ROOT / "config/simulation.yaml", *SETTINGS, "--set", "robot.port=%s" % (self.folder / "robot"),
             "--set", "laser.port=%s" % (self.folder / "laser"), "--set", "map.file=%s" % (self.folder / "m0.yaml"), "--set", "control.socket=%s" % (self.folder / "ctl"),
             "--set", "recording.file=%s" % (self.folder / "live.pcapng"), "--out", self.folder / "live"], stderr=open(self.folder / "daemon.log", "w"))
        try:
            self.wait(lambda: json.loads(self.ctl("--json", "status") or "{}").get("localized", 0) > 10)
            self.ctl("drive", "wander")
            time.sleep(seconds / 2)
            pose = json.loads(self.ctl("--json", "status"))["pose"]
            self.ctl("relocalize", "%.3f,%.3f,%.1f" % (pose["x_m"] + 0.4, pose["y_m"] - 0.3, pose.get("heading_deg", pose.get("theta_deg", 0.0))))
            self.ctl("pause")
            time.sleep(seconds / 4)
            self.ctl("resume")
            time.sleep(seconds / 4)
        finally:
            daemon.terminate()
            daemon.wait(60)

    def ctl(self, *words):
        return subprocess.run([self.tool, "ctl", "--socket", self.folder / "ctl", *words], capture_output=True, text=True).stdout

    def wait(self, holds):
        until = time.monotonic() + 120
        while not holds():
            if time.monotonic() > until:
                fail("the daemon does not localize:\n" + (self.folder / "daemon.log").read_text()[-2000:])
            time.sleep(0.3)

    def replay(self, recording):
        out = self.folder / "replayed"
        shutil.rmtree(out, ignore_errors=True)
        done = subprocess.run([self.tool, "replay", recording, "--map", self.folder / "m0.yaml", "--config", ROOT / "config/simulation.yaml", *SETTINGS, "--out", out],
                              capture_output=True, text=True)
        return Replay(done, out)


class Replay:
    def __init__(self, done, out):
        lines = done.stderr.replace("\r", "\n").split("\n")
        self.warnings = [line.split("warning: ", 1)[1] for line in lines if "warning: " in line]
        self.refusal = next((line for line in reversed(lines) if line.startswith("deltamap: ") and "warning" not in line), "") if done.returncode else ""
        self.poses, self.map, self.revisions = [], "", 0
        if done.returncode == 0:
            rows = [line.split() for line in (out / "trajectory.tum").read_text().splitlines()]
            self.poses = [tuple(row[1:]) for row in rows]
            self.map = hashlib.sha256((out / "map.pgm").read_bytes()).hexdigest()
            report = json.loads((out / "report.json").read_text())
            self.revisions, self.journal = report["revisions_total"], report["journal"]

    def told(self):
        return [self.refusal] if self.refusal else self.warnings

    def same(self, whole):
        return not self.refusal and self.poses == whole.poses and self.map == whole.map

    def off_m(self, whole):
        """The farthest of the poses of scans of the same number."""
        if not self.poses:
            return float("nan")
        return max(((float(a[0]) - float(b[0])) ** 2 + (float(a[1]) - float(b[1])) ** 2) ** 0.5 for a, b in zip(self.poses, whole.poses))


def packets_with(recording, text):
    """Numbers of the packets whose comment holds a text."""
    shown = subprocess.run(["tshark", "-r", recording, "-T", "fields", "-e", "frame.number", "-e", "frame.comment"], capture_output=True, text=True).stdout
    return [line.split("\t")[0] for line in shown.splitlines() if text in line]


def foreign_capture(file, first_ns):
    """Three packets of Ethernet in the classic format, in microseconds."""
    data = struct.pack("<IHHiIII", 0xA1B2C3D4, 2, 4, 0, 0, 65535, 1)
    for i in range(3):
        data += struct.pack("<IIII", first_ns // 10**9 + i, 0, 60, 60) + bytes(60)
    file.write_bytes(data)


def edits(folder, live):
    """Name, and a shell command that makes $OUT of $IN."""
    count = int(subprocess.run(["capinfos", "-Mcr", live], capture_output=True, text=True).stdout.split()[-1] or 0)
    orders = packets_with(live, "relocalized") + packets_with(live, "mapping ")
    remarks = " ".join("-a %s:%s" % (number, shlex.quote("here it was carried")) for number in orders)
    remarks_everywhere = " ".join("-a %d:%s" % (number, shlex.quote("seen")) for number in range(1, min(count, 400)))
    middle = count // 2
    return [
        ("untouched", "cp $IN $OUT"),
        ("editcap", "editcap $IN $OUT"),
        ("editcap -F pcapng", "editcap -F pcapng $IN $OUT"),
        ("editcap -a, a remark on each order", "editcap %s $IN $OUT" % remarks),
        ("editcap -a, a remark of two lines on each order", "editcap %s $IN $OUT" % remarks.replace("carried", "carried\r\nby two people")),
        ("editcap -a twice, remarks on each order", "editcap %s $IN $OUT.1; editcap %s $OUT.1 $OUT" % (remarks, remarks)),
        ("editcap -a, a remark on each of 400 packets", "editcap %s $IN $OUT" % remarks_everywhere),
        ("editcap -a, a remark that reads like a note", "editcap -a %d:'revision 7 before scan 40' $IN $OUT" % middle),
        ("editcap --discard-all-secrets, --capture-comment", "editcap --discard-all-secrets --capture-comment 'first drive' $IN $OUT"),
        ("editcap --inject-secrets", "printf 'CLIENT_RANDOM 00 00\\n' >$OUT.keys; editcap --inject-secrets tls,$OUT.keys $IN $OUT"),
        ("editcap -s 40", "editcap -s 40 $IN $OUT"),
        ("editcap -s 20", "editcap -s 20 $IN $OUT"),
        ("editcap -s 10000", "editcap -s 10000 $IN $OUT"),
        ("editcap -C 3", "editcap -C 3 $IN $OUT"),
        ("editcap -C 3 -L", "editcap -C 3 -L $IN $OUT"),
        ("editcap -C 1 -C -1 -L, from both ends", "editcap -C 1 -C -1 -L $IN $OUT"),
        ("editcap -E 0.001, errors", "editcap -E 0.001 --seed 5 $IN $OUT"),
        ("editcap -d, doubled packets out", "editcap -d $IN $OUT"),
        ("editcap -D 2", "editcap -D 2 $IN $OUT"),
        ("editcap, without the first", "editcap $IN $OUT 1"),
        ("editcap, without one in the middle", "editcap $IN $OUT %d" % middle),
        ("editcap, without 200 in the middle", "editcap $IN $OUT %d-%d" % (middle, middle + 200)),
        ("editcap -r, the first half", "editcap -r $IN $OUT 1-%d" % middle),
        ("editcap -r, the second half", "editcap -r $IN $OUT %d-%d" % (middle, count)),
        ("editcap, without the last", "editcap $IN $OUT %d" % count),
        ("editcap -t 3600", "editcap -t 3600 $IN $OUT"),
        ("editcap -t -0.0005", "editcap -t -0.0005 $IN $OUT"),
        ("editcap -S 0, strict times", "editcap -S 0 $IN $OUT"),
        ("editcap -S -0.01, equal distances", "editcap -S -0.01 $IN $OUT"),
        ("editcap -T ether", "editcap -T ether $IN $OUT"),
        ("editcap -F pcap", "editcap -F pcap $IN $OUT"),
        ("editcap -i 10, one part", "editcap -i 10 $IN $OUT.part; cp $(ls $OUT*part* | sed -n 2p) $OUT"),
        ("editcap -c 700, parts joined by mergecap -a", "editcap -c 700 $IN $OUT.part; mergecap -a -w $OUT $(ls $OUT*part*)"),
        ("editcap -c 700, parts joined by mergecap", "editcap -c 700 $IN $OUT.part; mergecap -w $OUT $(ls $OUT*part*)"),
        ("editcap -c 700, parts joined by mergecap -I none", "editcap -c 700 $IN $OUT.part; mergecap -a -I none -w $OUT $(ls $OUT*part*)"),
        ("editcap -c 700, parts joined by cat", "editcap -c 700 $IN $OUT.part; cat $(ls $OUT*part*) >$OUT"),
        ("editcap -c 700, parts joined in another order", "editcap -c 700 $IN $OUT.part; mergecap -a -w $OUT $(ls -r $OUT*part*)"),
        ("editcap -c 700, joined without one part", "editcap -c 700 $IN $OUT.part; mergecap -a -w $OUT $(ls $OUT*part* | sed 2d)"),
        ("mergecap of it alone", "mergecap -w $OUT $IN"),
        ("mergecap -s 40", "mergecap -s 40 -w $OUT $IN"),
        ("mergecap with itself", "mergecap -w $OUT $IN $IN"),
        ("mergecap -a with itself", "mergecap -a -w $OUT $IN $IN"),
        ("mergecap behind a foreign capture", "mergecap -w $OUT %s $IN" % (folder / "foreign.pcap")),
        ("mergecap -a -I none behind a foreign capture", "mergecap -a -I none -w $OUT %s $IN" % (folder / "foreign.pcap")),
        ("mergecap before a foreign capture", "mergecap -w $OUT $IN %s" % (folder / "foreign.pcap")),
        ("tshark -w", "tshark -Q -r $IN -w $OUT"),
        ("tshark -w, the robot alone", "tshark -Q -r $IN -Y 'frame.interface_name == \"robot\"' -w $OUT"),
        ("tshark -w, what has bytes", "tshark -Q -r $IN -Y 'frame.len > 0' -w $OUT"),
        ("tshark -w, the first 20 s", "tshark -Q -r $IN -Y 'frame.time_relative < 20' -w $OUT"),
        ("tshark -w, without the laser's answers", "tshark -Q -r $IN -Y '!(frame.interface_name == \"laser\" && frame.len < 60)' -w $OUT"),
        ("tshark -w -F pcap", "tshark -Q -r $IN -F pcap -w $OUT"),
        ("tshark -w, compressed", "tshark -Q -r $IN --compress-type gzip -w $OUT 2>/dev/null || gzip -c $IN >$OUT"),
        ("gzip", "gzip -c $IN >$OUT"),
        ("zstd", "zstd -q -c $IN >$OUT || printf '\\050\\265\\057\\375' >$OUT"),
        ("reordercap", "reordercap $IN $OUT"),
        ("cut in a block", "head -c $(($(stat -c %s $IN) * 2 / 3 + 1)) $IN >$OUT"),
    ]


def verdict(name, replay, whole):
    if replay.same(whole):
        return ("same", "; ".join(replay.told())) if replay.told() else ("same", "")
    if replay.told():
        return "told", replay.told()[0]
    return "SILENT", "%d scans of %d, up to %.2f m off, %d revisions for %d, journal %s" % (
        len(replay.poses), len(whole.poses), replay.off_m(whole), replay.revisions, whole.revisions, replay.journal["state"])


def main():
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument("--bin", type=pathlib.Path, default=ROOT / "build/release/bin")
    options.add_argument("--seconds", type=float, default=40)
    options.add_argument("--keep", type=pathlib.Path, help="folder of the recording; one that is there is not made anew")
    options.add_argument("--out", type=pathlib.Path)
    wanted = options.parse_args()
    for tool in ("editcap", "mergecap", "tshark", "reordercap", "capinfos"):
        if shutil.which(tool) is None:
            fail(tool + " is not installed: apt-get install wireshark-common tshark")
    began = time.monotonic()
    with tempfile.TemporaryDirectory() as scratch:
        folder = wanted.keep or pathlib.Path(scratch)
        folder.mkdir(parents=True, exist_ok=True)
        live = folder / "live.pcapng"
        recorded = Recorded.__new__(Recorded) if live.exists() else Recorded(wanted.bin, folder, wanted.seconds)
        recorded.programs, recorded.folder, recorded.tool = wanted.bin, folder, wanted.bin / "deltamap"
        whole = recorded.replay(live)
        if not whole.poses or whole.warnings or whole.journal["state"] != "obeyed":
            fail("the recording is not replayed: %s" % (whole.told() or whole.journal))
        foreign_capture(folder / "foreign.pcap", time.time_ns())
        rows = []
        for name, command in edits(folder, live):
            for left in folder.glob("edited*"):
                left.unlink()
            edited = folder / "edited.pcapng"
            done = subprocess.run(["bash", "-c", command], env=dict(os.environ, IN=str(live), OUT=str(edited)), capture_output=True, text=True)
            if not edited.exists() or edited.stat().st_size == 0:
                rows.append((name, "–", "the program itself refuses: " + (done.stderr.strip().splitlines() or [""])[0]))
            else:
                rows.append((name,) + verdict(name, recorded.replay(edited), whole))
            print("%-52s %-7s %s" % rows[-1], flush=True)
    silent = sum(row[1] == "SILENT" for row in rows)
    judged = sum(row[1] != "–" for row in rows)
    print("%d of %d the same or told" % (judged - silent, judged))
    if wanted.out:
        tools = subprocess.run(["editcap", "--version"], capture_output=True, text=True).stdout.split("\n")[0]
        lines = ["Written by `./dev bench recordings` (%s, %s, %.0f s)." % (project.provenance(), datetime.date.today(), time.monotonic() - began), "",
                 "A live run of %d scans on the simulated robot, with a new pose, a pause and its end by an operator, went through %s; each file was replayed. *Same*: trajectory "
                 "and map are those of the recording as it was written. **%d of %d are the same or told.**" % (len(whole.poses), tools.strip("."), judged - silent, judged), "",
                 "| edited by | replay | what is told |", "|---|---|---|"]
        strip = lambda text: text.replace(str(folder) + "/", "").replace("|", "\\|")
        lines += ["| %s | %s | %s |" % (strip(name), "**silent**" if is_same == "SILENT" else is_same, strip(why)) for name, is_same, why in rows]
        project.write_section(wanted.out, "Recordings that went through other programs", lines)
    return 1 if silent else 0


if __name__ == "__main__":
    sys.exit(main())
