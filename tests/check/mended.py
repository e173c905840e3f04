#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs the tests of what was mended and writes docs/results/mended.md: each point, its tests, before and after, passed or
not. Called by ./dev check mended, which builds the release preset first.

  mended.py [--point N]...     --point: runs these alone and writes nothing

The rows stand in mended.json beside this file, a list of objects:

  point    number of the point; rows are sorted by it
  what     one line: what was wrong, or is promised
  tests    names as ctest knows them (GoogleTest's Suite.Name, or the name of a script's test; * and ? as in file names),
           or a command of its own after "$ ", run in the project's folder: exit code 0 is passed
  before   what was measured before; text
  after    optional text. {name} stands for a figure that one of the row's tests prints as a line of its own,

               figure name = value unit        (tests/support/files/figure.hpp)

           without `after`, all figures that they print are listed.

A test that is not there is shown as missing, one that was skipped as skipped: neither counts as passed."""
import argparse, fnmatch, json, os, pathlib, re, subprocess, sys, tempfile, xml.etree.ElementTree

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from project import DATA, ROOT, provenance, run

BUILD = ROOT / "build/release"
ROWS = pathlib.Path(__file__).with_suffix(".json")
RESULT = ROOT / "docs/results/mended.md"
FIGURE = re.compile(r"^figure (\S+) = (.+?)\s*$", re.MULTILINE)
PASSED, FAILED, SKIPPED, MISSING = "passed", "**failed**", "**skipped**", "**missing**"


def environment():
    return {**os.environ, "DELTAMAP_DATA": str(DATA)}


def known_tests():
    listed = json.loads(run("ctest", "--test-dir", BUILD, "--show-only=json-v1"))
    return [test["name"] for test in listed["tests"]]


def ran_by_ctest(names):
    """{name: (outcome, what it printed)}"""
    if not names:
        return {}
    with tempfile.TemporaryDirectory() as folder:
        report = pathlib.Path(folder) / "junit.xml"
        subprocess.run(["ctest", "--test-dir", str(BUILD), "-R", "^(%s)$" % "|".join(map(re.escape, sorted(names))), "--output-junit", str(report),
                        "--test-output-size-passed", "1000000", "--test-output-size-failed", "1000000"], env=environment(), stdout=sys.stderr)
        outcomes = {}
        for case in xml.etree.ElementTree.parse(report).getroot().iter("testcase"):
            outcome = {"run": PASSED, "fail": FAILED}.get(case.get("status"), SKIPPED)
            outcomes[case.get("name")] = outcome, case.findtext("system-out") or ""
        return outcomes


def ran_as_command(command):
    done = subprocess.run(command, shell=True, cwd=ROOT, env=environment(), text=True, stdout=subprocess.PIPE)
    return PASSED if done.returncode == 0 else FAILED, done.stdout


def results_of(rows):
    """For each row the list of (test, outcome, what it printed)."""
    known = known_tests()
    wanted = {test: fnmatch.filter(known, test) for row in rows for test in row["tests"] if not test.startswith("$ ")}
    ran = ran_by_ctest({name for names in wanted.values() for name in names})
    for command in {test for row in rows for test in row["tests"] if test.startswith("$ ")}:
        wanted[command], ran[command] = [command], ran_as_command(command[2:])
    return [[(test, worst([ran[name][0] if name in ran else MISSING for name in wanted[test]]),
              "".join(ran[name][1] for name in wanted[test] if name in ran)) for test in row["tests"]] for row in rows]


def worst(outcomes):
    return next((one for one in (FAILED, SKIPPED, MISSING) if one in outcomes), PASSED if outcomes else MISSING)


def after_text(row, results):
    figures = {name: value for _, _, printed in results for name, value in FIGURE.findall(printed)}
    if "after" not in row:
        return ", ".join("%s %s" % (name.replace("_", " "), value) for name, value in figures.items())
    return re.sub(r"\{(\w+)\}", lambda name: figures.get(name.group(1), "(%s: not measured)" % name.group(1)), row["after"])


def in_a_cell(text):
    return str(text).replace("|", "\\|").replace("\n", " ")


def table(rows, results):
    lines = ["| point | what | test | before | after | |", "|---|---|---|---|---|---|"]
    for row, ran in sorted(zip(rows, results), key=lambda pair: pair[0]["point"]):
        tests = "<br>".join("`%s`%s" % (in_a_cell(test), "" if outcome == PASSED else " " + outcome) for test, outcome, _ in ran)
        cells = [row["point"], row["what"], tests, row["before"], after_text(row, ran), worst([outcome for _, outcome, _ in ran])]
        lines.append("| %s |" % " | ".join(cell if cell is tests else in_a_cell(cell) for cell in cells))
    return lines


def markdown(rows, results):
    passed = sum(worst([outcome for _, outcome, _ in ran]) == PASSED for ran in results)
    return "\n".join(["# What was mended", "", "Written by `./dev check mended`: %s. %d of %d rows passed." % (provenance(), passed, len(rows)), "",
                      *table(rows, results)]) + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--point", type=int, action="append")
    points = parser.parse_args().point
    rows = [row for row in json.loads(ROWS.read_text()) if not points or row["point"] in points]
    if not rows:
        parser.error("no row of point %s" % ", ".join(map(str, points or [])))
    results = results_of(rows)
    print("\n".join(table(rows, results)))
    if not points:
        RESULT.write_text(markdown(rows, results))
        print("written: %s" % RESULT.relative_to(ROOT))
    raise SystemExit(0 if all(outcome == PASSED for ran in results for _, outcome, _ in ran) else 1)


if __name__ == "__main__":
    main()
