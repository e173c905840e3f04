#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes the figures of docs/paper.md, between its two markers, from docs/results/experiments.json. ./dev experiments calls it
when it has measured; a test holds the page against the measurements.

  paper_figures.py            writes them
  paper_figures.py --check    exit code 1 where they are not what was measured"""
import json, pathlib, re, sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
PAGE = ROOT / "docs/paper.md"
MEASURED = ROOT / "docs/results/experiments.json"
BEGIN = "<!-- figures: written by tests/bench/paper_figures.py -->"
END = "<!-- figures: end -->"

GATE = ["straight", "past-changes", "turning-0.4", "turning-0.8", "turning-1.6"]

# What, the paper's, ours with {figure:format} taken from the experiment's summary, and the experiment.
# Formats: those of Python's numbers, and "pct" for whole per cent.
ROWS = [
    ("Fig. 2–4: largest r_d", "above 0 only with a change",
     "{no change: largest r_d:.2f} without, {change: largest r_d:.2f} with a change", "fig2-4"),
    ("Fig. 2–4: scans with r_d > 0", "none without a change",
     "{no change: scans with r_d > 0:pct} without a change, {change: scans with r_d > 0 with the change in view:pct} with it in view, "
     "{change: scans with r_d > 0 with none in view:pct} with none in view", "fig2-4"),
    ("Fig. 2–4: scans stored a lap", "–", "{no change: scans stored in a lap:.0f} without, {change: scans stored in a lap:.0f} with a change", "fig2-4"),
    ("scans with a change in view that are told at 2 % false alarms", "–",
     "r_d {scans with a change in view that r_d tells, 2 % false alarms:pct}; beams against the map (evidence) "
     "{scans with the change in view that beams tell (evidence), no more false alarms:.1%}", "fig2-4"),
    ("Fig. 6: N_eff / particles", "falls while turning, not by a change",
     "straight {500x60, straight: N_eff / particles:.2f}, past changes {500x60, past-changes: N_eff / particles:.2f}; turning at 0.4, 0.8, "
     "1.6 rad/s " + ", ".join("{500x60, %s: N_eff / particles:.2f}" % kind for kind in GATE[2:]), "fig6"),
    ("Fig. 6: scans that the gate of N_eff rejects, the same five", "while turning",
     ", ".join("{500x60, %s: rejected by the gate:pct}" % kind for kind in GATE), "fig6"),
    ("Table 1: MA1 in the paper's hall, mean acceptance", "0.9977",
     "{MA1, the paper's hall, continuous angles: mean acceptance:.4f} over continuous angles; pose right "
     "{MA1, the paper's hall, continuous angles: pose right:.1%}", "table1"),
    ("Table 1: MA1 in all four layouts, mean acceptance; that of the true pose", "–",
     "{MA1, all four layouts, continuous angles: mean acceptance:.4f}; {MA1, all four layouts, continuous angles: mean acceptance of the true pose:.4f}; pose right "
     "{MA1, all four layouts, continuous angles: pose right:.1%}", "table1"),
    ("Table 1: time of MA1", "0.67 s", "{MA1, all four layouts, continuous angles: mean CPU time:.0f} ms of CPU", "table1"),
    ("Table 2: ten drives of two hours, acceptance (method evidence)", "0.968–0.980",
     "{hall: acceptance, least:.4f} and more, within {hall: acceptance_perfect - acceptance, most:.4f} of the perfect mapper's", "table2"),
    ("Table 2: what of the changes the map follows ([skill](glossary.md#figures))", "–", "{hall: skill, least:.3f} and more, mean {hall: skill, mean:.3f}", "table2"),
    ("Table 2: error of the pose", "< 0.5 m, one loss in ten",
     "mean at most {hall: error_mean_m, most:.4f} m, 99 % within {hall: error_p99_m, most:.3f} m; lost {hall: not_tracking, most:.1%} of the time",
     "table2"),
    ("Fig. 10–12: error of the pose", "< 0.5 m",
     "mean at most {hall: error_mean_m, most:.4f} m, 99 % within {hall: error_p99_m, most:.3f} m", "fig10-12"),
    ("Fig. 13: four boxes of the room gone, contour F1 against the truth", "by visual inspection",
     "first map {evidence: boxes gone, contour F1 of the first map against the truth, mean:.3f}; paper {paper: boxes gone, contour F1 against the truth, mean:.3f}, evidence "
     "{evidence: boxes gone, contour F1 against the truth, mean:.3f}", "fig13"),
    ("Fig. 13: the boxes back, contour F1 against the first map; cells that differ", "by visual inspection",
     "paper {paper: boxes back, contour F1 against the first map, mean:.3f} (worst {paper: boxes back, contour F1 against the first map, worst:.3f}), "
     "{paper: boxes back, cells that are not, mean:.0f} cells; evidence {evidence: boxes back, contour F1 against the first map, mean:.3f} "
     "(worst {evidence: boxes back, contour F1 against the first map, worst:.3f}), {evidence: boxes back, cells that are not, mean:.0f} cells", "fig13"),
    ("Fig. 14: CPU a scan outside and inside Δ-phases, peak", "peaks, no number",
     "; ".join("%s {%s: CPU a scan outside, mean:.2f}, {%s: CPU a scan inside, mean:.2f}, {%s: CPU a scan inside, peak:.0f} ms" % ((m,) * 4)
               for m in ("paper", "evidence")), "fig14"),
    ("Fig. 14: resident memory, peak, simulator included", "≤ 92 MB",
     "paper {paper: resident memory, simulator and all, peak:.0f} MB, evidence {evidence: resident memory, simulator and all, peak:.0f} MB; in the "
     "second hour {paper: resident memory, grown by in the second half:+.1f} and {evidence: resident memory, grown by in the second half:+.1f} MB",
     "fig14"),
] + [
    ("beyond the paper, %s: acceptance short of the true pose's own, of {%s: transforms:.0f} merges" % (name, name), "–",
     "mean {%s: acceptance short of the true pose's own, mean:.4f}, worst {%s: acceptance short of the true pose's own, worst:.4f}; off by "
     "{%s: off, mean:.2f} cells, 99 %% within {%s: off, 99 %% within:.2f}; refused {%s: refused:.0f}, wrong and not refused "
     "{%s: wrong and not refused, of 10 000:.0f}; {%s: CPU time, mean:.1f} ms of CPU" % ((name,) * 7), "merge")
    for name in ("with prior", "without a prior")
]


def values_of(summary):
    """Figures by name; where a name comes again, the later ones have @1, @2, … behind it."""
    values = {}
    for figure in summary["figures"]:
        name, again = figure["name"], 0
        while name in values:
            again += 1
            name = "%s@%d" % (figure["name"], again)
        values[name] = figure["value"]
    return values


def filled(template, values):
    def text(match):
        name, form = match.group(1), match.group(2)
        if name not in values:
            raise SystemExit("docs/results/experiments.json has no figure '%s'" % name)
        value = values[name]
        if value is None:
            return "nothing"
        return "%.0f %%" % (100 * value) if form == "pct" else format(value, form).replace("%", " %")
    return re.sub(r"\{(.+?):([^:{}]+)\}", text, template)


def told_once(parts):
    """Runs, first seed and commit of each experiment in the table, a line for those that share seed and commit."""
    groups = {}
    for name in dict.fromkeys(row[-1] for row in ROWS):
        summary = parts[name]["summary"]
        groups.setdefault((summary["seed"], summary.get("commit", parts[name]["revision"])), []).append("%s (%d)" % (name, summary["runs"]))
    return "\n".join("Runs from seed %d, at %s: %s." % (seed, commit, ", ".join(names)) for (seed, commit), names in groups.items())


def table(parts):
    lines = ["| figure | paper | ours | `deltamap-lab` |", "|---|---|---|---|"]
    for what, papers, ours, name in ROWS:
        values = values_of(parts[name]["summary"])
        lines.append("| %s | %s | %s | %s |" % (filled(what, values), papers, filled(ours, values), name))
    return "\n".join(lines) + "\n\n" + told_once(parts)


def with_figures(page, parts):
    before, _, rest = page.partition(BEGIN)
    _, end, after = rest.partition(END)
    if not end:
        raise SystemExit("docs/paper.md: the markers of the figures are gone")
    return before + BEGIN + "\n" + table(parts) + "\n" + END + after


def write(page=PAGE, measured=MEASURED, only_check=False):
    text = page.read_text()
    new = with_figures(text, json.loads(measured.read_text()))
    if new == text:
        return
    if only_check:
        raise SystemExit("docs/paper.md: its figures are not those of docs/results/experiments.json: run tests/bench/paper_figures.py")
    page.write_text(new)


if __name__ == "__main__":
    write(only_check=sys.argv[1:] == ["--check"])
