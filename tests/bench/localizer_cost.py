# SPDX-License-Identifier: Apache-2.0
"""What the localizer costs: runs build/*/bench/localizer_cost, alone for times and under callgrind for instructions."""
import errno, functools, re, subprocess, sys

from measuring import ROOT, row, run

X86_64 = ROOT / "build/release/bench/localizer_cost"
ATOM = ROOT / "build/atom/bench/localizer_cost"
COUNTED_SCANS = 100


def figures(program, what, beams, quick, scans=1500):
    """What the program prints, by name. `beams` 0: all 181."""
    text = run(program, what, beams, 3 if quick else 9, 300 if quick else scans)
    return {name: float(value) for name, value in (line.split() for line in text.splitlines())}


def counted(program, what, beams, scans, within="measured(*"):
    """Instructions inside the measured section, or inside one function of it, and how many units of it were done."""
    done = subprocess.run(["valgrind", "--tool=callgrind", "--callgrind-out-file=/dev/null", "--collect-atstart=no",
                           "--toggle-collect=" + within, program, what, str(beams), "1", str(scans)],
                          cwd=ROOT, text=True, capture_output=True)
    instructions = re.search(r"Collected : (\d+)", done.stderr)
    units = re.search(r"^units (\S+)", done.stdout, re.MULTILINE)
    if done.returncode or not instructions or not units:
        raise SystemExit("callgrind on %s %s failed:\n%s%s" % (program, what, done.stdout, done.stderr))
    return int(instructions.group(1)), float(units.group(1))


def instructions(program, what, beams):
    """Per unit."""
    total, units = counted(program, what, beams, COUNTED_SCANS)
    return total / units


def weighing_rows(program, on, quick, limit, peers):
    made = []
    for beams, peer in peers:
        f = figures(program, "weigh", beams, quick)
        made.append(row("weighing, per particle and beam, %d beams%s" % (beams or 181, on),
                        "%.2f ns; %.1f instructions" % (f["ns"], instructions(program, "weigh", beams)),
                        "≤ %d ns" % limit, f["ns"] <= limit, peer))
    return made


def update_rows(program, on, quick, limits):
    made = []
    for beams, limit, peer in limits:
        f = figures(program, "update", beams, quick)
        made.append(row("whole update, 500 × %d%s" % (beams or 181, on),
                        "%.0f µs; %.0f thousand instructions" % (f["mean_us"], instructions(program, "update", beams) / 1e3),
                        "≤ %d µs" % limit if limit else "", f["mean_us"] <= limit if limit else None, peer))
    return made


def tracking_rows(program, on, quick, judged):
    made = []
    few = "with particles.min 100"
    for job, how, beams in (("track_few", few, 60), ("track", "as delivered", 60), ("track", "as delivered", 0)):
        f = figures(program, job, beams, quick, scans=3000)
        met = f["mean_us"] <= 80 and f["rmse_m"] <= 0.02 if judged and beams else None
        made.append(row("a tracking scan %s, KLD and refinement, static hall, %d beams%s" % (how, beams or 181, on),
                        "%.0f µs at %.3f m (%.0f particles); %.0f thousand instructions"
                        % (f["mean_us"], f["rmse_m"], f["particles"], instructions(program, job, beams) / 1e3),
                        "≤ 80 µs at ≤ 0.02 m" if met is not None else "", met,
                        "iris_lama (no particles) 28 µs at 0.045 m" if met is not None else ""))
    return made


@functools.cache
def runs_atom():
    """Whether this kernel runs 32-bit programs: it may have been built without them."""
    try:
        subprocess.run([str(ATOM)], capture_output=True)
    except OSError as error:
        if error.errno != errno.ENOEXEC:
            raise
        print("localizer_cost: the 32-bit build is not measured: %s" % error, file=sys.stderr)
        return False
    return True


def programs():
    """Program, and what its rows are called besides."""
    return [(X86_64, "")] + ([(ATOM, ", 32-bit build")] if runs_atom() else [])


def rows(quick):
    return x86_64_rows(quick) + (atom_rows(quick) if runs_atom() else [])


def x86_64_rows(quick):
    return (weighing_rows(X86_64, "", quick, 4, [(60, "beluga 13.7 ns, MRPT 37, amcl 50, nav2 54"), (0, "beluga 9.0 ns")])
            + update_rows(X86_64, "", quick, [(60, 150, "beluga 411 µs, nav2 1616"), (0, 400, "beluga 815 µs, nav2 3871")])
            + tracking_rows(X86_64, "", quick, True))


def atom_rows(quick):
    atom = ", 32-bit build"
    return (weighing_rows(ATOM, atom, quick, 10, [(60, "nav2 133 ns"), (0, "")])
            + update_rows(ATOM, atom, quick, [(60, 0, ""), (0, 0, "")])
            + tracking_rows(ATOM, atom, quick, False))


def patch_rows(quick):
    made = []
    for program, on in programs():
        f = figures(program, "patch", 0, quick)
        made.append(row("a 5 × 5 m container patched into a 700² field%s" % on,
                        "%.2f ms (whole rebuild %.1f ms); %.1f million instructions"
                        % (f["ms"], f["rebuild_ms"], instructions(program, "patch", 0) / 1e6),
                        "" if on else "≤ 1 ms", None if on else f["ms"] <= 1,
                        "" if on else "full rebuild 35–70 ms; iris_lama 0.8–3 ms"))
    return made


def memory_rows(quick):
    made = []
    for program, on in programs():
        f = figures(program, "memory", 0, quick)
        made.append(row("resident memory, this localizer alone, 700² map, 2000 particles%s" % on,
                        "%.1f MB (peak %.1f MB)" % (f["VmRSS"], f["VmHWM"]), "" if on else "≤ 14 MB",
                        None if on else f["VmHWM"] <= 14, "" if on else "nav2 core 16 MB"))
    return made


def warehouse_rows(quick):
    """A robot that does not know where it is, in warehouses of three sizes and among corridors a kilometre long."""
    made = []
    for place, where, within_s, peer in (("100", "in a warehouse of 100 × 100 m", 8, ""), ("200", "in a warehouse of 200 × 200 m", 8, "beluga 26 to 57 s"),
                                         ("400", "in a warehouse of 400 × 400 m", 12, ""), ("corridors", "among eight corridors of 1 km", 60, "")):
        starts = []
        for seed in range(1, 3 if quick else 6):
            text = run(X86_64.with_name("warehouse_start"), place, str(seed))
            starts.append({name: float(value) for name, value in (line.split() for line in text.splitlines())})
        slowest_s = max(start["found_s"] for start in starts)
        longest_ms = max(start["longest_ms"] for start in starts)
        met = min(start["found_s"] for start in starts) >= 0 and slowest_s <= within_s and longest_ms <= 25
        made.append(row("global start %s, %d seeds: the slowest; the longest scan" % (where, len(starts)),
                        "%.1f s; %.0f ms" % (slowest_s, longest_ms), "≤ %d s; ≤ 25 ms" % within_s, met, peer))
    return made
