#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Does every experiment and writes docs/results/experiments.md, ablation.md, unseen.md and things.md from what each leaves in its summary.json;
what was measured and at which revision is kept in experiments.json beside it. Called by ./dev experiments.

  experiments.py [--quick] [--only NAME]... [--seed N] [--jobs N]
  experiments.py --page FOLDER
      --quick: short drives, few seeds; writes into build/ alone
      --only: does these anew and keeps what is known of the others
      --jobs: drives at once; experiments that measure the machine do one
      --page: only writes the page of an ablation or of unseen worlds that `deltamap-lab NAME --out FOLDER` has
              done"""
import argparse, collections, json, os, pathlib, subprocess, sys

sys.path.insert(0, str(pathlib.Path(__file__).parent))
import paper_figures
from measuring import DATA, LAB, ROOT, in_a_cell, processor, row_of_figure, run, table_lines, told

OUT = ROOT / "build/experiments"
OF_THE_LOCALIZER = {"hall", "stale-map", "verdict"}  # ./dev bench localization


def experiments():
    """Name, and whether it measures the machine."""
    listed = [line.split("\t") for line in run(LAB, "--list").splitlines()]
    return {name: (times == "times", what) for name, times, what in listed if name not in OF_THE_LOCALIZER}


def revision():
    """What is measured; results that are written on the way do not count as changes."""
    changed = run("git", "status", "--porcelain", "--untracked-files=no", "--", ".", ":!docs/results").strip()
    return run("git", "describe", "--always").strip() + ("-dirty" if changed else "")


def section(part):
    """One experiment in the report."""
    summary = part["summary"]
    rows = [row_of_figure(figure) for figure in summary["figures"]]
    judged = [row["met"] for row in rows if row["met"] is not None]
    met = " %d of %d met." % (sum(judged), len(judged)) if judged else ""
    # Measured before summaries named their program: the script's own revision.
    program = "version %s, commit %s, settings %s: %s" % (
        summary["version"], summary["commit"], summary["settings"]["fingerprint"], told(summary["settings"])) \
        if "commit" in summary else "at " + part["revision"]
    lines = ["## " + summary["experiment"], "",
             "%s. %d runs from seed %d%s, %s.%s" % (part["what"], summary["runs"], summary["seed"], ", quick" if summary["quick"] else "", program, met), ""]
    return lines + table_lines(rows, "paper, others")


def markdown(parts):
    judged = [figure["met"] for part in parts for figure in part["summary"]["figures"] if "met" in figure]
    lines = ["# The experiments, measured", "",
             "Written by `./dev experiments` on %s. What each experiment does stands in `docs/experiments.md`. %d of %d figures met."
             % (processor(), sum(judged), len(judged)), ""]
    for part in parts:
        lines += section(part) + [""]
    return "\n".join(lines)


ABLATION = """# What each mechanism and each key is worth

Written by `./dev experiments`, or from what `deltamap-lab ablation` has left in its folder, on %s: %s.

A row changes one thing: a mechanism is switched off, or a key is set to half or twice its value. The same worlds of `unseen` are
driven through as delivered. A cell tells the mean difference to that, its 95 %% interval (bootstrap over the worlds), and in how many
worlds the change is better : worse; `0`: no world differs. More is better of `recall`, `precision` and `skill`, less of all
others. `carried_`: in a hall that is half out of date, the robot is carried one bay on, some decimetres, or anywhere; seconds
with the pose off by more than 0.3 m, cells written meanwhile, share of the time that the gate was shut after it. Bold: the
interval leaves out 0. Of twenty cells that nothing moves, one is bold by chance.
"""

UNSEEN = """# Worlds that nobody has tuned on

Written by `./dev experiments --only unseen --seed 1000`, or from what `deltamap-lab unseen` has left in its folder, on %s:
%s.

Every seed is another kind of building, first map, laser, robot and life in it ([what is drawn](../experiments.md)). Seeds 1 to
999 are for development; 1000 to 1059 for final figures. Why figures are missed:
[known limits](known-limits.md).
"""

THINGS = """# Things: told once, rightly, in their size?

Written by `./dev experiments --only things`, or from what `deltamap-lab things` has left in its folder, on %s: %s.

Containers come, go and are pushed aside in simulated worlds; what is told of them is held against what the fork-lift did. A change
counts once a face of it was in view for 10 s, also where a later one, or one beside it, touched its place before more was seen.
It does not count where nobody could tell it from what was there before: of a container that came and went unseen, and of one that was put
where another had gone unseen, not a single look shows a difference. *Seen all around*: of those, where each face of the container that
could be seen from the robot's floor was in view for 3 s before its place, or one beside it, changed again.
An event is what was told of a thing until it was told to be of another kind, or moved on. *Right*: the kind, and the middle of what is told lies on
the container's own floor. Figures of size are of those. In `pushes` containers stand side by side in rows and are pushed by less
than a metre: where the back is not seen nobody can tell a move from a body put before the row. In `racks` nothing changes.

*Solid acceptance* is Eq. 11 with insides of containers occupied, once a minute: as the map shows it, and with what is assumed of things.
Assumed cells of a container that has left out of sight count as wrong.

*Events a change* counts a change of which nothing was told as none, so that of the others the mean is higher. *Events "moved" that
were none* are a share of all events; of the events "moved" they are `wrong_pairs` of `told_moved` in the last table.
"""

BAYS = """# Bays: told rightly, and how soon?

Written by `./dev experiments --only bays`, or from what `deltamap-lab bays` has left in its folder, on %s: %s.

A yard that each seed draws: 24 bays of 2.4 m × 2.4 m in three rows, each empty, with a container, or with a pallet of 1.2 m × 0.8 to 1.0 m.
*Loads that come and go*: the robot drives round the rows for half an hour with localizer and mapping as delivered; every 15 s a load
comes or goes in a bay farther than 11 m. A bay is *in view* where 0.6 of the beams that lead to it, within 10 m, reach it; seconds count
from its change on, also over several visits. *Right*: empty, partly and full as it is; a bay that is still unknown is not right.
*Precision* leaves out the unknown, *recall* does not. *Ten people* walk and stand (2 to 20 s) in aisles and bays for 6.25 h a seed;
they come in along an aisle, and who is shut in between loads walks to another corner of the beat. Nothing else changes; the robot stands at another place every 90 s, its pose off by 2 cm and 0.2°. A *false flip* is any change of a state.
"""

ZONES = """# Zones: is nothing written, and is the pose as good?

Written by `./dev experiments --only zones`, or from what `deltamap-lab zones` has left in its folder, on %s: %s.

Worlds of [`unseen`](../experiments.md), each with six squares of 2 to 6 m about things that its first map knows. *Frozen*: localizer and mapping
as delivered; a cell counts as written if any revision has it other than the first map. *Ignored*: the map is never written, and within the
squares all that it has is drawn 0.5 m off in x and y; RMSE of the pose by that map and the zones, by the right map, and by that map without zones.
Within ignored zones the localizer is shown unknown ground, whatever the map has there: by the right map and these zones it is as far off, to the
digit. What is above 1 is what the beams into the squares would have told.
"""

# Their tables fill a page of their own. `empty`: what an empty table says; `seed`: of other seeds the page lies in the run's folder.
Page = collections.namedtuple("Page", "file about empty seed")
PAGES = {"ablation": Page("docs/results/ablation.md", ABLATION, "Not asked this time.", None),
         "unseen": Page("docs/results/unseen.md", UNSEEN, "None.", 1000),
         "things": Page("docs/results/things.md", THINGS, "None.", None),
         "bays": Page("docs/results/bays.md", BAYS, "None.", None),
         "zones": Page("docs/results/zones.md", ZONES, "None.", None)}


def page_of(summary):
    """Figures and tables of one experiment, on a page of its own."""
    made = "version %s, commit %s, settings %s: %s" % (
        summary["version"], summary["commit"], summary["settings"]["fingerprint"], told(summary["settings"]))
    page = PAGES[summary["experiment"]]
    lines = [page.about % (processor(), "%d runs from seed %d; %s" % (summary["runs"], summary["seed"], made))]
    lines += table_lines([row_of_figure(figure) for figure in summary["figures"]])
    for table in summary["tables"]:
        lines += ["", "## " + table["title"], ""]
        if not table["rows"]:
            lines.append(page.empty)
            continue
        lines += ["| %s |" % " | ".join(table["columns"]), "|" + "---|" * len(table["columns"])]
        lines += ["| %s |" % " | ".join(in_a_cell(cell) for cell in row) for row in table["rows"]]
    return "\n".join(lines) + "\n"


def write_page(summary, folder, quick):
    page = PAGES[summary["experiment"]]
    is_kept = not quick and page.seed in (None, summary["seed"])
    (ROOT / page.file if is_kept else folder / pathlib.Path(page.file).name).write_text(page_of(summary))


def done(name, measures_machine, arguments, folder):
    """Does one experiment, its progress on this terminal, and answers its summary."""
    command = [LAB, name, "--out", folder / name, "--seed", arguments.seed]
    command += ["--quick"] if arguments.quick else []
    jobs = 1 if measures_machine else arguments.jobs
    command += ["--jobs", jobs] if jobs else []
    print("%s …" % name, file=sys.stderr, flush=True)
    environment = dict(os.environ)
    if DATA.is_dir():
        environment["DELTAMAP_DATA"] = str(DATA)
    if subprocess.run([str(word) for word in command], cwd=ROOT, stdout=subprocess.DEVNULL, env=environment).returncode:
        raise SystemExit("experiment %s failed" % name)
    return json.loads((folder / name / "summary.json").read_text())


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--only", action="append")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--jobs", type=int)
    parser.add_argument("--page", type=pathlib.Path, metavar="FOLDER")
    arguments = parser.parse_args()
    if arguments.page:
        write_page(json.loads((arguments.page / "summary.json").read_text()), arguments.page, False)
        return
    known = experiments()
    unknown = sorted(set(arguments.only or []) - set(known))
    if unknown:
        parser.error("no experiment %s; there are %s" % (", ".join(unknown), ", ".join(known)))
    folder = OUT / ("quick" if arguments.quick else "full")
    folder.mkdir(parents=True, exist_ok=True)
    report = folder / "experiments.md" if arguments.quick else ROOT / "docs/results/experiments.md"
    kept = report.with_suffix(".json")
    at = revision()
    parts = json.loads(kept.read_text()) if kept.exists() else {}
    for name, (measures_machine, what) in known.items():
        if name not in (arguments.only or known):
            continue
        summary = done(name, measures_machine, arguments, folder)
        if name in PAGES:
            write_page(summary, folder, arguments.quick)
            continue
        summary.pop("tables", None)  # they are on the experiment's own page
        parts[name] = {"revision": at, "what": what, "summary": summary}
        parts = {one: parts[one] for one in known if one in parts}
        # At once: who interrupts a long run keeps what was done.
        kept.write_text(json.dumps(parts, indent=1, ensure_ascii=False) + "\n")
        report.write_text(markdown(list(parts.values())))
    page = ROOT / "docs/paper.md"
    if not arguments.quick and page.exists() and all(name in parts for *_, name in paper_figures.ROWS):
        paper_figures.write(page, kept)
    print("written: %s; pages in %s" % (report.relative_to(ROOT), folder.relative_to(ROOT)))
    raise SystemExit(0 if all(part["summary"]["met"] for part in parts.values()) else 1)


if __name__ == "__main__":
    main()
