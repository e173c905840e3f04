#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The dissector in the real tshark over recordings of simulated drives, with faults of both lines: ./dev bench dissector."""
import os
import pathlib
import re
import sys
import tempfile

sys.path[:0] = [str(pathlib.Path(__file__).resolve().parents[1] / name) for name in ("support", "recordings")]
import dissector
from project import ROOT, measure_a_section
from simulated_drives import varied_drives

BIN = pathlib.Path(os.environ.get("DELTAMAP_BIN", ROOT / "build/release/bin"))
DRIVES, SECONDS, AT_ONCE = 100, 12.0, 10


def measure(seed, quick):
    about = dissector.about_tshark()
    if not dissector.has_lua(about):
        raise SystemExit("tshark with Lua is not here: apt-get install tshark")
    total, kinds, recordings = {"frames": 0, "notes": 0, "garbage": 0, "malformed": 0, "unnamed": 0}, set(), 0
    with tempfile.TemporaryDirectory(prefix="deltamap-dissected-") as folder:
        for recording in varied_drives(BIN, pathlib.Path(folder), 4 if quick else DRIVES, SECONDS, AT_ONCE, seed):
            told = dissector.check(BIN / "deltamap", recording)
            recordings += 1
            kinds |= told["kinds"]
            for name in total:
                total[name] += told[name]
    is_met = dissector.failures == 0 and total["malformed"] == 0 and total["unnamed"] == 0
    lines = ["%d recordings of %.0f s of the daemon on simulated robots (worlds `hall`, `room`, `depot`; four line speeds, three variants of the laser, both units; none to three "
             "faults of lines and devices each) in tshark %s with `docs/protocols/deltamap.lua`, each frame held against `deltamap decode` and `deltamap info`:" % (
                 recordings, SECONDS, about.split("\n")[0].split(" (")[0]), "",
             "| frames | kinds of frames | notes | bytes of no frame | packets malformed | frames without a name | what differs from deltamap |", "|---|---|---|---|---|---|---|",
             "| %d | %d | %d | %d | %d | %d | %d |" % (total["frames"], len(kinds), total["notes"], total["garbage"], total["malformed"], total["unnamed"], dissector.failures), "",
             "Asked for: nothing malformed, every frame named, nothing that differs: %s." % ("met" if is_met else "**missed**")]
    return lines, is_met


if __name__ == "__main__":
    measure_a_section(__doc__, "./dev bench dissector", "The dissector", measure)
