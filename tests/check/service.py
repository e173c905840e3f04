#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs the tests of what an operator of the service is promised and writes them as a section of docs/results/service.md: each
promise, its tests, passed or not; then the unit's exposure and, where a package has been built, lintian. Called by
./dev check service, which builds the release preset first.

The promises stand in service.json beside this file: what each is about (`part`), what is promised, and the names of its tests as
ctest knows them (GoogleTest's Suite.Name, or the name of a script's test; * and ? as in file names). A test that is not there is
shown as missing, one that was skipped as skipped: neither counts as passed."""
import fnmatch, json, os, pathlib, re, shutil, subprocess, sys, tempfile, xml.etree.ElementTree

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from project import DATA, ROOT, provenance, run, write_section

BUILD = ROOT / "build/release"
ROWS = pathlib.Path(__file__).with_suffix(".json")
RESULT = ROOT / "docs/results/service.md"
MOST_EXPOSURE = 1.5
PASSED, FAILED, SKIPPED, MISSING = "passed", "**failed**", "**skipped**", "**missing**"


def known_tests():
    listed = json.loads(run("ctest", "--test-dir", BUILD, "--show-only=json-v1"))
    return [test["name"] for test in listed["tests"]]


def outcomes_by_ctest(names):
    """{name: outcome}"""
    if not names:
        return {}
    with tempfile.TemporaryDirectory() as folder:
        report = pathlib.Path(folder) / "junit.xml"
        subprocess.run(["ctest", "--test-dir", str(BUILD), "-R", "^(%s)$" % "|".join(map(re.escape, sorted(names))), "--output-junit", str(report)],
                       env={**os.environ, "DELTAMAP_DATA": str(DATA)}, stdout=sys.stderr)
        return {case.get("name"): {"run": PASSED, "fail": FAILED}.get(case.get("status"), SKIPPED)
                for case in xml.etree.ElementTree.parse(report).getroot().iter("testcase")}


def results_of(rows):
    """For each row the list of (test as the row names it, outcome of all that it stands for)."""
    known = known_tests()
    wanted = {test: fnmatch.filter(known, test) for row in rows for test in row["tests"]}
    ran = outcomes_by_ctest({name for names in wanted.values() for name in names})
    return [[(test, worst([ran.get(name, MISSING) for name in wanted[test]])) for test in row["tests"]] for row in rows]


def worst(outcomes):
    return next((one for one in (FAILED, SKIPPED, MISSING) if one in outcomes), PASSED if outcomes else MISSING)


def told(*command):
    return subprocess.run(command, cwd=ROOT, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)


def exposure():
    """(what, how, outcome)"""
    what = "exposure of the unit, at most %.1f" % MOST_EXPOSURE
    if not shutil.which("systemd-analyze"):
        return what, "no systemd-analyze here", SKIPPED
    found = re.search(r"exposure level for \S+: ([0-9.]+)", told("systemd-analyze", "security", "--offline=true", "--no-pager", "systemd/deltamap.service").stdout)
    return what, found.group(1) if found else "not told", PASSED if found and float(found.group(1)) <= MOST_EXPOSURE else FAILED


def lintian():
    what = "lintian of the package, without errors and warnings"
    packages = sorted(str(one.relative_to(ROOT)) for one in ROOT.glob("build/deb/*/deltamap_*.deb"))
    if not packages or not shutil.which("lintian"):
        return what, "no package here" if not packages else "no lintian here", SKIPPED
    done = told("lintian", "--fail-on", "error,warning", *packages)
    return what, ", ".join(pathlib.Path(one).name for one in packages), FAILED if done.returncode else PASSED


def lines_of(rows, results):
    lines = ["| about | what | test | |", "|---|---|---|---|"]
    for row, ran in zip(rows, results):
        tests = "<br>".join("`%s`%s" % (test, "" if outcome == PASSED else " " + outcome) for test, outcome in ran)
        lines.append("| %s | %s | %s | %s |" % (row["part"], row["what"].replace("|", "\\|"), tests, worst([outcome for _, outcome in ran])))
    return lines + ["| service | %s | %s | %s |" % one for one in (exposure(), lintian())]


def main():
    rows = json.loads(ROWS.read_text())
    lines = lines_of(rows, results_of(rows))
    print("\n".join(lines))
    write_section(RESULT, "What is tested", ["Written by `./dev check service`: %s." % provenance(), ""] + lines)
    sys.exit(1 if any(FAILED in line or MISSING in line for line in lines) else 0)


if __name__ == "__main__":
    main()
