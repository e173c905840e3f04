# SPDX-License-Identifier: Apache-2.0
"""What the scripts that replay recorded logs share: options, references, a replay with its score, and the table of the runs."""
import argparse, csv, json, pathlib, sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from project import DATA, ROOT, run, unpacked

TOOLS = DATA.parent / "tools"
# Of the laser, m (../shared/data/README.md). That of duke by its turns on the spot: the log tells the laser by the robot's pose.
AHEAD_M = {"intel": 0.0, "wean3": 0.25, "aces": 0.0, "duke": 0.4, "p3dx0": 0.0, "uma_map": 0.78, "uma_loc": 0.78}


def options(description, seeds):
    parser = argparse.ArgumentParser(description=description, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("out", help="folder for the result")
    parser.add_argument("--tool", default=ROOT / "build/release/bin/deltamap", help="the program that is measured")
    parser.add_argument("--seeds", type=int, default=seeds)
    parser.add_argument("--only", default="", help="only runs with this in their name")
    parser.add_argument("--set", action="append", default=[], help="KEY=VALUE over the settings")
    return parser


def reference_of(log, data):
    """[(stamp, x, y, theta)] of the laser in the map."""
    lines = unpacked("reference/%s.gt.txt" % log, data).read_text().splitlines()
    return [tuple(float(word) for word in line.split()) for line in lines if line.strip() and line[0] != "#"]


def replayed(tool, log, recording, map_file, folder, seed, settings, *start):
    """Replays, and answers the score of the trajectory."""
    run(tool, "replay", recording, "--map", map_file, "--config", ROOT / "config/pioneer.yaml", "--out", folder,
        "--seed", seed, "--set", "laser.mount.x_m=%g" % AHEAD_M[log], *start,
        *(word for setting in settings for word in ("--set", setting)))
    return json.loads(run(sys.executable, TOOLS / "score_trajectory.py", folder / "trajectory.tum",
                          DATA / ("reference/%s.gt.txt.xz" % log), "--laser", AHEAD_M[log]))


def write_table(file, rows):
    with open(file, "w", newline="", encoding="utf-8") as table:
        writer = csv.DictWriter(table, fieldnames=rows[0])
        writer.writeheader()
        writer.writerows(rows)
