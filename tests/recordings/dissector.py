#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""docs/protocols/deltamap.lua in the real tshark, held against `deltamap decode` and `deltamap info`: every frame by the same name, with the
same values, nothing malformed. Without recordings on the command line it makes its own: all golden frames of both devices, in chunks that cut
them anywhere, with noise and notes between, and an imported log. Exit code 77: tshark, or its Lua, is not here.
usage: dissector.py FOLDER-OF-PROGRAMS [RECORDING...]"""
import collections, json, pathlib, random, re, shutil, struct, subprocess, sys, tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
SCRIPT = ROOT / "docs/protocols/deltamap.lua"
PORTS = {"arcos": "robot", "lms2xx": "laser"}
failures = 0


def fail(recording, why):
    global failures
    failures += 1
    print("%s: %s" % (pathlib.Path(recording).name, why))


# --- recordings ---------------------------------------------------------------------------------------------------------------------------

def block(kind, body):
    length = struct.pack("<I", len(body) + 12)
    return struct.pack("<I", kind) + length + body + length


def options(*pairs):
    text = b"".join(struct.pack("<HH", code, len(value)) + value + b"\0" * (-len(value) % 4) for code, value in pairs)
    return text + b"\0\0\0\0"


def packet(interface, ns, data, direction, note=""):
    told = [(2, struct.pack("<I", direction))] + ([(1, note.encode())] if note else [])
    return block(6, struct.pack("<IIIII", interface, ns >> 32, ns & 0xFFFFFFFF, len(data), len(data)) + data + b"\0" * (-len(data) % 4) + options(*told))


def golden_recording(file):
    """The golden frames of one device and direction one behind the other; cut anywhere; in virtual time, each chunk when its last byte came."""
    streams = [(0, 1, "arcos_packets"), (0, 2, "arcos_commands"), (1, 1, "lms_replies"), (1, 1, "lms_scans"), (1, 2, "lms_requests")]
    dice = random.Random(1)
    head = block(0x0A0D0D0A, struct.pack("<IHHq", 0x1A2B3C4D, 1, 0, -1))
    for name, link in (("robot", 147), ("laser", 148)):
        head += block(1, struct.pack("<HHI", link, 0, 0) + options((2, name.encode()), (8, struct.pack("<Q", 500000)), (9, b"\x09")))
    out, ns = [head], 1_700_000_000_000_000_000
    for interface, direction, name in streams:
        data = b"\x57\x4d\x53\x32\x0d" + (ROOT / "tests/data" / (name + ".bytes")).read_bytes()
        while data:
            size = dice.choice((1, 2, 3, 7, 40, 400))
            ns += 10_000_000
            out.append(packet(interface, ns, data[:size], direction))
            data = data[size:]
            if dice.random() < 0.05:
                out.append(packet(0, ns, b"", 0, "mapping paused before scan 12 at 1700000000123456789"))
        ns += 300_000_000  # a frame that is cut is given up
    file.write_bytes(b"".join(out))


def imported_recording(tool, folder):
    fan = " ".join("%.2f" % (1 + 0.01 * i) for i in range(180))
    log = folder / "log"
    log.write_text("".join("FLASER 180 %s %g 0 0 %g 0 0 %.2f host %.2f\n" % (fan, 0.1 * i, 0.1 * i, 1 + 0.2 * i, 1 + 0.2 * i) for i in range(20)))
    subprocess.run([tool, "import", "carmen", log, folder / "imported.pcapng"], check=True, capture_output=True)
    return folder / "imported.pcapng"


# --- what both say ------------------------------------------------------------------------------------------------------------------------

class Told:
    """Names, garbage and values by port and direction, in order."""

    def __init__(self):
        self.names, self.garbage, self.notes = collections.defaultdict(list), collections.Counter(), []
        self.x, self.words, self.arguments = [], [], []


FIELDS = ["frame.packet_flags_direction", "arcos.name", "lms2xx.name", "arcos.garbage", "lms2xx.garbage", "deltamap.note", "arcos.sip.x", "lms2xx.word",
          "arcos.argument"]


def told_by_tshark(recording):
    command = ["tshark", "-n", "-X", "lua_script:%s" % SCRIPT, "-r", recording, "-T", "fields", "-E", "aggregator=|", "-E", "separator=/t"]
    done = subprocess.run(command + [word for field in FIELDS for word in ("-e", field)], capture_output=True, text=True)
    complaints = [line for line in done.stderr.splitlines() if "could be dangerous" not in line]
    if done.returncode or complaints:
        fail(recording, "tshark: " + "; ".join(complaints or ["exit code %d" % done.returncode]))
    told = Told()
    for line in done.stdout.splitlines():
        direction, robot, laser, robot_garbage, laser_garbage, notes, x, words, arguments = (line + "\t" * len(FIELDS)).split("\t")[:len(FIELDS)]
        way = "out" if int(direction or "0", 0) == 2 else "in"
        for port, names, garbage in (("robot", robot, robot_garbage), ("laser", laser, laser_garbage)):
            told.names[port, way] += names.split("|") if names else []
            told.garbage[port, way] += sum(len(one) // 2 for one in garbage.split("|"))
        told.notes += [one for one in notes.split("|") if one and not one.startswith("recording ends at ")]  # the reader's own
        told.x += [int(one) for one in x.split("|")] if x else []
        told.words += [int(one) for one in words.split("|")] if words else []
        told.arguments += [int(one) for one in arguments.split("|")] if arguments else []
    return told


def told_by_decode(tool, recording):
    done = subprocess.run([tool, "decode", "--json", recording], capture_output=True, text=True, check=True)
    told = Told()
    for frame in map(json.loads, done.stdout.splitlines()):
        line, fields = (frame["port"], frame["direction"]), frame["fields"]
        if frame["name"] == "note":
            told.notes.append(fields["text"])
        elif frame["name"] == "garbage":
            told.garbage[line] += frame["bytes"]
        else:
            told.names[line].append(frame["name"])
            told.x += [fields["x_units"]] if frame["name"] == "SIP" else []
            told.words += fields.get("words", [])
            told.arguments += [fields["argument"]] if isinstance(fields.get("argument"), int) else []
    return told


def count_of(recording, display_filter):
    command = ["tshark", "-n", "-X", "lua_script:%s" % SCRIPT, "-r", recording, "-Y", display_filter]
    return len(subprocess.run(command, capture_output=True, text=True).stdout.splitlines())


def compare(recording, what, ours, theirs):
    if ours != theirs:
        at = next((i for i, (a, b) in enumerate(zip(ours, theirs)) if a != b), min(len(ours), len(theirs)))
        fail(recording, "%s differ from number %d on: deltamap %s of %d, tshark %s of %d" % (what, at, ours[at:at + 3], len(ours), theirs[at:at + 3], len(theirs)))


def check(tool, recording):
    ours, theirs = told_by_decode(tool, recording), told_by_tshark(recording)
    info = json.loads(subprocess.run([tool, "info", "--json", recording], capture_output=True, text=True, check=True).stdout)[0]
    for port in ("robot", "laser"):
        for way, role in (("in", "said"), ("out", "heard")):
            compare(recording, "names of %s %s" % (port, way), ours.names[port, way], theirs.names[port, way])
            told = info[port][role]
            if dict(collections.Counter(theirs.names[port, way])) != told["frames"]:
                fail(recording, "deltamap info counts other frames of %s, %s" % (port, way))
            if theirs.garbage[port, way] != told["garbage_bytes"] or ours.garbage[port, way] != told["garbage_bytes"]:
                fail(recording, "bytes of no frame of %s, %s: info %d, decode %d, tshark %d" % (port, way, told["garbage_bytes"], ours.garbage[port, way], theirs.garbage[port, way]))
    compare(recording, "notes", ours.notes, theirs.notes)
    compare(recording, "x of SIPs", ours.x, theirs.x)
    compare(recording, "words of scans", ours.words, theirs.words)
    compare(recording, "arguments", ours.arguments, theirs.arguments)
    malformed = count_of(recording, '_ws.malformed || _ws.lua.error || _ws.expert.group == "Malformed"')
    if malformed:
        fail(recording, "%d packets are malformed" % malformed)
    unnamed = [name for names in theirs.names.values() for name in names if name.startswith(("packet of unknown", "command "))]
    print("%s: %d frames, %d notes, %d bytes of garbage, %d malformed, %d without a name" %
          (pathlib.Path(recording).name, sum(map(len, theirs.names.values())), len(theirs.notes), sum(theirs.garbage.values()), malformed, len(unnamed)))
    return {"frames": sum(map(len, theirs.names.values())), "kinds": {(*line, name) for line, names in theirs.names.items() for name in names},
            "notes": len(theirs.notes), "garbage": sum(theirs.garbage.values()), "malformed": malformed, "unnamed": len(unnamed)}


def about_tshark():
    """What it says of itself; empty: it is not here."""
    return subprocess.run(["tshark", "--version"], capture_output=True, text=True).stdout if shutil.which("tshark") else ""


def has_lua(about):
    return bool(re.search(r"with\s+Lua", about))


def main():
    tool = pathlib.Path(sys.argv[1]) / "deltamap"
    about = about_tshark()
    if not has_lua(about):
        print("skipped: tshark with Lua is not here (apt-get install tshark)")
        sys.exit(77)
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        given = sys.argv[2:]
        if not given:
            golden_recording(folder / "golden.pcapng")
            given = [folder / "golden.pcapng", imported_recording(tool, folder)]
        for recording in given:
            check(tool, recording)
    sys.exit(1 if failures else 0)


if __name__ == "__main__":
    main()
