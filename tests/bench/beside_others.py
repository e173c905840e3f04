# SPDX-License-Identifier: Apache-2.0
"""What the localizer costs beside other localizers: pf-localization of MRPT (Debian's mrpt-apps), run here on the same log and map where it is
installed, and figures of others that were measured once, on one machine, on the same drives. Whether pf-localization keeps its pose is
not looked at."""
import os, re, shutil, subprocess

import localizer_cost
import on_intel
from measuring import OUT, row, run, unpacked

PARTICLES, BEAMS, LOG_BEAMS = 500, 60, 180
# Start within 0.1 m and 5 degrees of the known one; every third beam of 180; no windows, no logs.
CONFIG = """[KLD_options]
KLD_binSize_PHI_deg=10
KLD_binSize_XY=0.10
KLD_delta=0.01
KLD_epsilon=0.01
KLD_minSamplesPerBin=0
KLD_maxSampleSize=%(particles)d
KLD_minSampleSize=%(particles)d
[PF_options]
PF_algorithm=0
resamplingMethod=0
adaptiveSampleSize=0
BETA=0.5
sampleSize=%(particles)d
[DummyOdometryParams]
minStdXY=0.02
minStdPHI=1.0
[LocalizationExperiment]
use_3D_poses=false
experimentRepetitions=1
map_file=ref_intel.gridmap.gz
rawlog_file=intel.rawlog
logOutput_dir=log
3DSceneFrequency=0
SAVE_STATS_ONLY=true
particles_count=%(particles)d
init_PDF_mode=1
init_PDF_min_x=%(min_x).3f
init_PDF_max_x=%(max_x).3f
init_PDF_min_y=%(min_y).3f
init_PDF_max_y=%(max_y).3f
init_PDF_min_yaw_deg=%(min_deg).1f
init_PDF_max_yaw_deg=%(max_deg).1f
SHOW_PROGRESS_3D_REAL_TIME=false
[MetricMap]
occupancyGrid_count=1
pointsMap_count=0
likelihoodMapSelection=0
[MetricMap_occupancyGrid_00_creationOpts]
resolution=0.05
[MetricMap_occupancyGrid_00_insertOpts]
[MetricMap_occupancyGrid_00_likelihoodOpts]
likelihoodMethod=4
LF_decimation=%(each_beam)d
LF_stdHit=0.20
LF_maxCorrsDistance=0.30
LF_zHit=0.95
LF_zRandom=0.05
LF_maxRange=80
"""


def config():
    x, y, degrees = (float(word) for word in on_intel.KNOWN_START.split(","))
    return CONFIG % {"particles": PARTICLES, "each_beam": LOG_BEAMS // BEAMS, "min_x": x - 0.1, "max_x": x + 0.1, "min_y": y - 0.1,
                     "max_y": y + 0.1, "min_deg": degrees - 5, "max_deg": degrees + 5}


def mrpt_on_intel():
    """Version, CPU seconds and peak MiB of the whole program; or why there are none, in words."""
    if not all(shutil.which(name) for name in ("pf-localization", "carmen2rawlog", "ros-map-yaml2mrpt")):
        return "not installed (mrpt-apps)"
    folder = OUT / "mrpt"
    folder.mkdir(parents=True, exist_ok=True)
    run("carmen2rawlog", "-i", unpacked("logs/intel.log"), "-o", folder / "intel.rawlog", "-q", "-w")
    unpacked("maps/ref_intel.pgm")
    run("ros-map-yaml2mrpt", "-i", unpacked("maps/ref_intel.yaml"), "-d", folder, "-q", "-w")
    (folder / "pf.ini").write_text(config())
    with (folder / "pf.log").open("w") as log:
        program = subprocess.Popen(["pf-localization", "pf.ini"], cwd=folder, stdin=subprocess.DEVNULL, stdout=log, stderr=log)
        _, status, used = os.wait4(program.pid, 0)
        program.returncode = os.waitstatus_to_exitcode(status)
    told = (folder / "pf.log").read_text()
    if program.returncode or "Total execution time" not in told:
        return "failed with %d" % program.returncode  # build/bench-localization/mrpt/pf.log tells why
    return re.search(r"MRPT (\d[\d.]*)", told).group(1), used.ru_utime + used.ru_stime, used.ru_maxrss / 1024


def replayed(beams):
    return on_intel.replay("cost-%d" % beams, 1, "--initial-pose", on_intel.KNOWN_START, "--set", "localization.particles.min=%d" % PARTICLES,
                           "--set", "localization.particles.max=%d" % PARTICLES, "--set", "localization.beams=%d" % beams)[1]


def intel_rows():
    if on_intel.missing_data():
        return on_intel.missing_data()
    reports = [replayed(beams) for beams in (BEAMS, 0)]
    scans = reports[0]["scans"]
    ours_ms, ours_mib = 1e3 * reports[0]["cpu"]["total_s"] / scans, reports[0]["peak_resident_bytes"] / 2**20
    theirs = mrpt_on_intel()
    met, peers = None, "pf-localization: %s" % (theirs,)
    if not isinstance(theirs, str):
        name, cpu_s, mib = theirs
        their_ms = 1e3 * cpu_s / scans
        met, peers = ours_ms < their_ms and ours_mib < mib, "pf-localization (MRPT %s) %.2f ms; %.0f MiB" % (name, their_ms, mib)
    localizing = ["%.0f µs" % (1e6 * report["cpu"]["localization_s"] / scans) for report in reports]
    return [row("a scan of `intel`, %d particles, %d beams, all that the program does; its peak" % (PARTICLES, BEAMS),
                "%.2f ms; %.0f MiB" % (ours_ms, ours_mib), "less of both" if met is not None else "", met, peers),
            row("localizing a scan of `intel`, %d / all beams" % BEAMS, " / ".join(localizing), "", None, "iris_lama (no particles) 66 / 168 µs")]


def rows():
    hall = ["%.0f µs" % localizer_cost.figures(localizer_cost.X86_64, "track", beams, False)["mean_us"] for beams in (60, 0)]
    found_s = [float(dict(line.split() for line in run(localizer_cost.X86_64.with_name("warehouse_start"), "200", seed).splitlines())["found_s"])
               for seed in range(1, 4)]
    slowest = "%.1f s" % max(found_s) if min(found_s) >= 0 else "not found"
    return intel_rows() + [
        row("a tracking scan, static hall, 60 / 181 beams", " / ".join(hall), "", None, "iris_lama (no particles) 29 / 65 µs"),
        row("global start in a warehouse of 200 × 200 m, the slowest of 3 seeds", slowest, "", None, "beluga 26 to 57 s")]
