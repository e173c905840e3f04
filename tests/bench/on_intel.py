# SPDX-License-Identifier: Apache-2.0
"""The localizer on the real log `intel`: from its known start, and from nowhere at 20 times. Errors are in the map's
frame, without alignment; what the reference itself may be off is told by the relations between its poses."""
import bisect, json, lzma, math

from measuring import DATA, OUT, ROOT, TOOL, median, row, run, unpacked

KNOWN_START = "9.442,-3.389,-156.2"
SAME_TIME_S = 0.05
LOST_M = 0.5
FOUND_DEG = 10.0
FOUND_WITHIN_S = 60.0
STARTS = 20


def read_poses(path):
    """[(t, x, y, theta)] of a TUM file or of 't x y theta' lines, .xz too."""
    poses = []
    with (lzma.open(path, "rt") if str(path).endswith(".xz") else open(path)) as lines:
        for line in lines:
            v = [float(x) for x in line.split()] if line.strip() and line[0] != "#" else []
            if v:
                poses.append((v[0], v[1], v[2], 2 * math.atan2(v[6], v[7]) if len(v) >= 8 else v[3]))
    return sorted(poses)


def nearest(times, t):
    at = bisect.bisect(times, t)
    i = min((j for j in (at - 1, at) if 0 <= j < len(times)), key=lambda j: abs(times[j] - t))
    return i if abs(times[i] - t) <= SAME_TIME_S else None


def errors(estimate, reference):
    """[(t, m, deg)] of the estimates that have a reference."""
    times, found = [pose[0] for pose in reference], []
    for t, x, y, theta in estimate:
        i = nearest(times, t)
        if i is not None:
            off_deg = abs(math.degrees(math.remainder(theta - reference[i][3], 2 * math.pi)))
            found.append((t, math.hypot(x - reference[i][1], y - reference[i][2]), off_deg))
    return found


def interpolated(poses, times, t):
    at = bisect.bisect(times, t)
    if at == 0 or at == len(times):
        return None
    a, b = poses[at - 1], poses[at]
    share = (t - a[0]) / (b[0] - a[0])
    return t, a[1] + share * (b[1] - a[1]), a[2] + share * (b[2] - a[2]), a[3] + share * math.remainder(b[3] - a[3], 2 * math.pi)


def motion_between(a, b):
    dx, dy, c, s = b[1] - a[1], b[2] - a[2], math.cos(a[3]), math.sin(a[3])
    return c * dx + s * dy, -s * dx + c * dy


def relations_mean_m(estimate):
    """Mean distance between the motions that the relations state and those of the estimate (Kümmerle et al., "On
    measuring the accuracy of SLAM algorithms", 2009); nothing where the data has no relations."""
    file = DATA / "reference/intel.relations.xz"
    if not file.exists():
        return None
    times, off_m = [pose[0] for pose in estimate], []
    for line in lzma.open(file, "rt"):
        t1, t2, x, y = map(float, line.split()[:4])
        one, other = interpolated(estimate, times, t1), interpolated(estimate, times, t2)
        if one and other:
            dx, dy = motion_between(one, other)
            off_m.append(math.hypot(dx - x, dy - y))
    return sum(off_m) / len(off_m)


def recording():
    target = OUT / "intel.pcapng"
    if not target.exists():
        OUT.mkdir(parents=True, exist_ok=True)
        run(TOOL, "import", "carmen", unpacked("logs/intel.log"), target)
    return target


def replay(name, seed, *options):
    folder = OUT / "runs" / name
    unpacked("maps/ref_intel.pgm")
    run(TOOL, "replay", recording(), "--map", unpacked("maps/ref_intel.yaml"), "--config", ROOT / "config/pioneer.yaml", "--out", folder,
        "--seed", seed, "--set", "laser.mount.x_m=0", "--set", "mapping.enabled=false", *options)
    return read_poses(folder / "trajectory.tum"), json.loads((folder / "report.json").read_text())


def missing_data():
    return [] if (DATA / "logs/intel.log.xz").exists() else [row("intel", "not measured: no data at $DELTAMAP_DATA", "", None)]


def known_start_rows(quick):
    if missing_data():
        return missing_data()
    reference, made = read_poses(DATA / "reference/intel.gt.txt.xz"), []
    for beams, told in ((60, "60 beams"), (0, "all beams")):
        rmse, lost, relations = [], [], []
        for seed in range(1, 3 if quick else 6):
            poses, _ = replay("intel-%d-%d" % (beams, seed), seed, "--initial-pose", KNOWN_START,
                              "--set", "localization.particles.min=500", "--set", "localization.particles.max=500",
                              "--set", "localization.beams=%d" % beams)
            off_m = [m for _, m, _ in errors(poses, reference)]
            rmse.append(math.sqrt(sum(m * m for m in off_m) / len(off_m)))
            lost.append(len(reference) - sum(m <= LOST_M for m in off_m))
            relations.append(relations_mean_m(poses))
        beside = "" if relations[0] is None else "; relations, mean: %.3f m (the reference itself: %.3f)" % (
            median(relations), relations_mean_m(reference))
        made.append(row("`intel` from its known start, 500 particles, %s: RMSE, seeds 1–%d" % (told, len(rmse)),
                        "%s m, lost %d scans%s" % (" ".join("%.3f" % m for m in rmse), max(lost), beside),
                        "≤ 0.06 m, lost 0", max(rmse) <= 0.06 and max(lost) == 0,
                        "iris_lama 0.061, nav2 0.089, beluga 0.094 m"))
    return made


def found_after_s(poses, reference, began):
    """From when on the estimate stays within 0.5 m and 10 degrees until the end; nothing where it never does."""
    since = None
    for t, off_m, off_deg in errors(poses, reference):
        right = off_m <= LOST_M and off_deg <= FOUND_DEG
        since = (t if since is None else since) if right else None
    return None if since is None else since - began


def global_start_rows(quick):
    if missing_data():
        return missing_data()
    reference = read_poses(DATA / "reference/intel.gt.txt.xz")
    begin, end = reference[0][0], reference[-1][0] - 2 * FOUND_WITHIN_S
    count = 5 if quick else STARTS
    found, worst_ms, notes = 0, 0.0, []
    for i in range(count):
        from_s = (end - begin) * i / (count - 1)
        poses, report = replay("intel-from-%02d" % i, 1 + i, "--from", "%.1f" % from_s)
        after_s = found_after_s(poses, reference, poses[0][0])
        found += after_s is not None and after_s <= FOUND_WITHIN_S
        worst_ms = max(worst_ms, report["latency_ms"]["max"])
        notes.append("%.0f" % after_s if after_s is not None else "never")
    target = "%d of %d" % (count, count)
    return [row("`intel`, global start at %d times: within 0.5 m and 10° inside 60 s, and stays to the end" % count,
                "%d of %d; s until right: %s" % (found, count, " ".join(notes)), target, found == count, "nav2, beluga 4 of 4 starts"),
            row("worst single update of these runs", "%.1f ms" % worst_ms, "≤ 15 ms", worst_ms <= 15)]
