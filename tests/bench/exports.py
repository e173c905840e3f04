#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""What `deltamap export` writes, read by the programs that it is for: ./dev bench exports. MRPT's carmen2rawlog and rawlog-edit (Debian:
mrpt-apps), and node with npm, which fetches @mcap/core and @foxglove/schemas; evo's rules for TUM files are restated here, and its own reader is
asked too where evo is installed. What is not here is told, and counts as missed."""
import math
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from project import ROOT, measure_a_section, run
from simulated_drives import Drive

BIN = pathlib.Path(os.environ.get("DELTAMAP_BIN", ROOT / "build/release/bin"))
DRIVES = [("hall", "180/1", "mm", 38400), ("room", "180/0.5", "mm", 500000), ("depot", "100/0.25", "cm", 38400)]
SECONDS = 25.0
POSE_DIGIT = 1e-6      # of CARMEN lines and TUM rows, m and rad
MRPT_DIGIT = 1e-5      # of what rawlog-edit prints


def rows_of(file, comment="%"):
    return [line.split() for line in file.read_text().splitlines() if line.strip() and not line.startswith(comment)]


def csv_of(source, folder):
    run(BIN / "deltamap", "export", "csv", source, folder / "csv")
    head, *rows = [line.split(",") for line in (folder / "csv").read_text().splitlines()]
    return [dict(zip(head, row)) for row in rows]


def against_tum(source, folder, known):
    """Rows, and how many of them break evo's rules (eight numbers with one space between, unit quaternions, times that rise) or tell another pose
    than `known`: (x, y, heading) by the time as it is written, cut to so many characters as its keys have."""
    run(BIN / "deltamap", "export", "tum", source, folder / "tum")
    lines, faults, held = (folder / "tum").read_text().splitlines(), 0, 0
    length = len(next(iter(known)))
    for line in lines:
        if not re.fullmatch(r"[^ ]+( [^ ]+){7}", line):
            faults += 1
            continue
        t, *numbers = line.split(" ")
        x, y, _, qx, qy, qz, qw = map(float, numbers)
        faults += abs(math.hypot(qx, qy, qz, qw) - 1.0) > 1e-6
        if t[:length] in known:
            held += 1
            wanted_x, wanted_y, wanted_rad = known[t[:length]]
            off_rad = math.remainder(2.0 * math.atan2(qz, qw) - wanted_rad, 2.0 * math.pi)
            faults += max(abs(x - wanted_x), abs(y - wanted_y), abs(off_rad)) > POSE_DIGIT
    stamps = [float(line.split(" ")[0]) for line in lines]
    faults += sum(later <= earlier for earlier, later in zip(stamps, stamps[1:]))
    return held, faults + len(lines) - held, evo_reads(folder / "tum", len(lines))


def wheels_of(recording, folder):
    """The poses of `deltamap export carmen`, by time."""
    run(BIN / "deltamap", "export", "carmen", recording, folder / "drive.log")
    rows = [line.split() for line in (folder / "drive.log").read_text().splitlines() if line.startswith("ODOM ")]
    return {row[7]: tuple(map(float, row[1:4])) for row in rows}


def poses_of(out, folder):
    """Those of `deltamap export csv` of a run."""
    return {row["time"]: tuple(float(row[name]) for name in ("x_m", "y_m", "heading_rad")) for row in csv_of(out, folder)}


def evo_reads(file, count):
    """Whether evo itself takes it; None: evo is not here."""
    try:
        from evo.tools import file_interface
    except ImportError:
        return None
    read = file_interface.read_tum_trajectory_file(str(file))
    return read.check()[0] and len(read.timestamps) == count


def mrpt_is_here():
    return shutil.which("carmen2rawlog") and shutil.which("rawlog-edit")


def against_mrpt(recording, folder):
    """Beams and faults of scans and poses that carmen2rawlog has read."""
    run("carmen2rawlog", "-i", folder / "drive.log", "-o", folder / "drive.rawlog", "-q", "-w")
    for what in ("--export-2d-scans-txt", "--export-odometry-txt"):
        subprocess.run(["rawlog-edit", "-q", "-i", "drive.rawlog", what], cwd=folder, check=True, capture_output=True)  # it writes where it stands
    scans, poses, wanted = rows_of(folder / "drive_ROBOTLASER1.txt"), rows_of(folder / "drive_ODOMETRY.txt"), csv_of(recording, folder)
    beams, faults = 0, abs(len(scans) - len(wanted)) + abs(len(poses) - len(wanted))
    for scan, pose, row in zip(scans, poses, wanted):
        ranges = row["ranges_m"].split(" ")
        told, valid = scan[1:1 + len(ranges)], scan[1 + len(ranges):]
        faults += len(valid) != len(ranges)
        for ours, theirs, is_valid in zip(ranges, told, valid):
            beams += 1
            expected = {"nan": "0.000", "inf": "%.3f" % float(row["max_range_m"])}.get(ours, ours)
            faults += theirs != expected or (float(is_valid) != 0.0) != (ours not in ("nan", "inf"))
        off = [abs(float(pose[i + 1]) - float(row[name])) for i, name in enumerate(("odom_x_m", "odom_y_m", "odom_heading_rad"))]
        faults += max(off) > 0.5 * (MRPT_DIGIT + POSE_DIGIT) * 1.01
    return len(scans), beams, faults


def against_mcap(recording, out):
    """What tests/interop/mcap.sh found; None: it did not agree, or could not be asked."""
    done = subprocess.run([ROOT / "tests/interop/mcap.sh", BIN, recording, out], capture_output=True, text=True)
    print(done.stdout + done.stderr[-2000:], file=sys.stderr)
    return [line for line in done.stdout.splitlines() if line.endswith("equal")] if done.returncode == 0 else None


def one_drive(folder, world, variant, units, baud, seed):
    drive = Drive(BIN, folder, world, seed, settings=["laser.variant=%s" % variant, "laser.units=%s" % units, "laser.baud=%d" % baud])
    try:
        drive.wander()
        time.sleep(SECONDS)
    finally:
        drive.end()
    run(BIN / "deltamap", "replay", drive.recording, "--map", folder / "map.yaml", "--config", ROOT / "config/simulation.yaml", "--out", folder / "run")
    return drive.recording, folder / "run"


def measure(seed, quick):
    rows, is_met, evo = [], True, []
    with tempfile.TemporaryDirectory(prefix="deltamap-exports-") as place:
        for number, (world, variant, units, baud) in enumerate(DRIVES[:1] if quick else DRIVES):
            folder = pathlib.Path(place) / str(number)
            recording, out = one_drive(folder, world, variant, units, baud, seed + number)
            told = "%s, `%s`, %s, %d baud" % (world, variant, units, baud)
            for what, source, known in (("wheels", recording, wheels_of(recording, folder)), ("run", out, poses_of(out, folder))):
                count, faults, by_evo = against_tum(source, folder, known)
                evo.append(by_evo)
                rows.append((told, "`tum` of the " + what, "evo's rules", "%d poses" % count, str(faults)))
                is_met = is_met and faults == 0 and by_evo is not False
            if mrpt_is_here():
                scans, beams, faults = against_mrpt(recording, folder)
                rows.append((told, "`carmen`", "MRPT's carmen2rawlog", "%d scans and poses, %d beams" % (scans, beams), str(faults)))
                is_met = is_met and faults == 0
            mcap = against_mcap(recording, out)
            rows.append((told, "`mcap` of recording and run", "@mcap/core, @foxglove/schemas", "; ".join(mcap or ["**not read**"]), "0" if mcap else "**1**"))
            is_met = is_met and mcap is not None
    by_evo = "not asked: it is not installed here" if None in evo else "takes all of them" if all(evo) else "**refuses some**"
    head = ["| drive of %.0f s | export | read by | what | differences |" % SECONDS, "|---|---|---|---|---|"]
    lines = ["Drives of the daemon on simulated robots. Scans and poses of runs are held against `deltamap export csv`, the wheels of `tum` against those of `carmen`, to the last digit that the format (or the reader's own text) holds. "
             "evo's own reader: %s.%s" % (by_evo, "" if mrpt_is_here() else " MRPT: **not asked**, for mrpt-apps is not installed here."), ""] + head + [
                 "| " + " | ".join(row) + " |" for row in rows] + ["", "Asked for: no difference: %s." % ("met" if is_met and mrpt_is_here() else "**missed**")]
    return lines, bool(is_met and mrpt_is_here())


if __name__ == "__main__":
    measure_a_section(__doc__, "./dev bench exports", "Exports", measure)
