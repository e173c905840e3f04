#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs the tests of what an operator of the service is promised and writes them as a section of docs/results/service.md: each
promise, its tests, passed or not; then the unit's exposure and, where a package has been built, lintian. Called by
./dev check service, which builds the release preset first. The promises stand in service.json beside this file; how their
tests are named and counted is told in mended.py."""
import json, pathlib, re, shutil, subprocess, sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import mended
from project import ROOT, provenance, write_section

ROWS = pathlib.Path(__file__).with_suffix(".json")
RESULT = ROOT / "docs/results/service.md"
MOST_EXPOSURE = 1.5


def told(*command):
    return subprocess.run(command, cwd=ROOT, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)


def exposure():
    """(what, how, outcome)"""
    what = "exposure of the unit, at most %.1f" % MOST_EXPOSURE
    if not shutil.which("systemd-analyze"):
        return what, "no systemd-analyze here", mended.SKIPPED
    found = re.search(r"exposure level for \S+: ([0-9.]+)", told("systemd-analyze", "security", "--offline=true", "--no-pager", "systemd/deltamap.service").stdout)
    return what, found.group(1) if found else "not told", mended.PASSED if found and float(found.group(1)) <= MOST_EXPOSURE else mended.FAILED


def lintian():
    what = "lintian of the package, without errors and warnings"
    packages = sorted(str(one.relative_to(ROOT)) for one in ROOT.glob("build/deb/*/deltamap_*.deb"))
    if not packages or not shutil.which("lintian"):
        return what, "no package here" if not packages else "no lintian here", mended.SKIPPED
    done = told("lintian", "--fail-on", "error,warning", *packages)
    return what, ", ".join(pathlib.Path(one).name for one in packages), mended.FAILED if done.returncode else mended.PASSED


def lines_of(rows, results):
    lines = ["| about | what | test | |", "|---|---|---|---|"]
    for row, ran in zip(rows, results):
        tests = "<br>".join("`%s`%s" % (test, "" if outcome == mended.PASSED else " " + outcome) for test, outcome, _ in ran)
        lines.append("| %s | %s | %s | %s |" % (row["part"], mended.in_a_cell(row["what"]), tests, mended.worst([outcome for _, outcome, _ in ran])))
    return lines + ["| service | %s | %s | %s |" % one for one in (exposure(), lintian())]


def main():
    rows = json.loads(ROWS.read_text())
    lines = lines_of(rows, mended.results_of(rows))
    print("\n".join(lines))
    write_section(RESULT, "What is tested", ["Written by `./dev check service`: %s." % provenance(), ""] + lines)
    sys.exit(1 if any(mended.FAILED in line or mended.MISSING in line for line in lines) else 0)


if __name__ == "__main__":
    main()
