# SPDX-License-Identifier: Apache-2.0
"""The rows that simulated drives answer: runs `deltamap-lab` and takes from its summary.json every figure that has
something to reach."""
import json

from measuring import LAB, OUT, row_of_figure, run


def experiment_rows(name, quick):
    folder = OUT / "runs" / ("experiment-" + name)
    run(LAB, name, "--out", folder, *(["--quick"] if quick else []))
    summary = json.loads((folder / "summary.json").read_text())
    return [row_of_figure(figure, name + ": ") for figure in summary["figures"] if figure.get("target")]


def hall_rows(quick):
    return experiment_rows("hall", quick)


def stale_map_rows(quick):
    return experiment_rows("stale-map", quick)


def verdict_rows(quick):
    return experiment_rows("verdict", quick)
