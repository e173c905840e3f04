# SPDX-License-Identifier: Apache-2.0
"""What a person meets on the live page, measured: how much of the window the map has, buttons that lie under something, words without a
line of the glossary, and values that are shown though nobody knows them."""

import re

from running_daemon import ROOT

# Buttons and the like whose middle belongs to something else, as far as one can scroll to them.
COVERED = """
const wrong = [];
for (const one of document.querySelectorAll("button, input, select, summary")) {
  const visible = one.checkVisibility({ visibilityProperty: true });
  if (!visible) continue;
  const target = one.labels?.[0] ?? one;
  target.scrollIntoView({ block: "nearest", behavior: "instant" });
  const box = target.getBoundingClientRect(), top = document.elementFromPoint(box.left + box.width / 2, box.top + box.height / 2);
  if (!top || !(target.contains(top) || top.contains(target) && top.tagName === "LABEL")) wrong.push((one.id || one.textContent.trim()) + " under " + (top?.id || top?.className || top?.tagName));
}
scrollTo(0, 0);
return wrong;"""

# The least share of the window's height that shows the map without anything over it, of columns across it; the layers' box stands at its right.
MAP_SHARE = """
scrollTo(0, 0);
const canvas = document.querySelector("#map"), box = canvas.getBoundingClientRect();
const shares = [0.2, 0.4, 0.6].map((across) => {
  let run = 0, longest = 0;
  for (let y = 0; y < innerHeight; ++y) {
    run = document.elementFromPoint(box.left + across * box.width, y) === canvas ? run + 1 : 0;
    longest = Math.max(longest, run);
  }
  return longest / innerHeight;
});
return Math.min(...shares);"""

# Whether the whole map, as Fit shows it, lies where nothing covers it.
FITS = """
const { view } = window.deltamap;
view.fit();
const { resolution_m: m, origin_m: [x, y] } = view.frame, { low_x, low_y, high_x, high_y } = view.known, box = view.canvas.getBoundingClientRect();
const hidden = [];
for (const [column, row] of [[low_x, low_y], [low_x, high_y], [high_x, low_y], [high_x, high_y], [(low_x + high_x) / 2, high_y], [(low_x + high_x) / 2, low_y], [high_x, (low_y + high_y) / 2]]) {
  const [px, py] = view.to_screen(x + column * m, y + row * m), top = document.elementFromPoint(box.left + px, box.top + py);
  if (top !== view.canvas) hidden.push([Math.round(px), Math.round(py), top?.id || top?.tagName]);
}
return hidden;"""

# Every word of the page that is no value, with its tooltip.
WORDS = """
const words = document.querySelectorAll("h2, dt, .badge, summary, button:not(#changes button), label, .key, figcaption b, figcaption span, #changes b, .what, .why, #run-time, #history-text");
return [...words].filter((one) => one.checkVisibility() && one.textContent.trim()).map((one) => [one.id || one.textContent.trim(), one.closest("[title]:not([title=''])")?.title ?? ""]);"""

# What stands in the status, the badges and the charts.
SHOWN = """
const rows = Object.fromEntries([...document.querySelectorAll("#status dt")].map((name) => [name.textContent, name.nextSibling.textContent]));
const gate = document.querySelector("#badge-gate");
return { rows, gate: [gate.textContent, gate.dataset.level], charts: [...document.querySelectorAll("figcaption span")].filter((one) => one.checkVisibility()).map((one) => one.textContent) };"""

BY_SCANS = ("P(pose right)", "P(map wrong)", "Scan fits", "Latency", "Particles")
PLACE = r"-?\d+\.\d+, -?\d+\.\d+ m"


def meanings():
    """The second column of the glossary's tables, as plain text."""
    text = (ROOT / "docs/glossary.md").read_text()
    rows = [line.split(" | ")[1].removesuffix(" |") for line in text.splitlines() if line.startswith("| ") and " | " in line]
    return {re.sub(r"[`*]", "", re.sub(r"\[([^\]]+)\]\([^)]*\)", r"\1", re.sub(r" \(note \d+\)", "", row))).strip().rstrip(".").lower() for row in rows}


def words_without_line(browser):
    known = meanings()
    return sorted({word for word, title in browser.execute_script(WORDS) if not any(title.rstrip(".").lower().endswith(line) for line in known)})


def shown_though_unknown(browser, *, scans=False, robot=False, mapping=True, place=False):
    """What stands there as known: without scans (now), without a robot, with mapping off, without any pose so far."""
    shown = browser.execute_script(SHOWN)
    rows, wrong = shown["rows"], []
    tells = lambda name, of=r"\d": [f"{name}: {rows[name]}"] if re.search(of, rows.get(name, "")) else []
    if not scans:
        wrong += [line for name in BY_SCANS for line in tells(name)]
        wrong += tells("Pose", f"^{PLACE}" if place else PLACE)  # where it was is known
    if not robot:
        wrong += tells("Battery")
    if not (scans and mapping):
        wrong += tells("Write gate", "^open") + (["gate: " + shown["gate"][0]] if shown["gate"][1] == "good" else [])
    if not mapping or not (scans or place):
        wrong += tells("Waits", r"\d|nothing")
    if not scans and not place:
        wrong += [value for value in shown["charts"] if re.search(r" -?\d", value)]
    return wrong
