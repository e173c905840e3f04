// SPDX-License-Identifier: Apache-2.0
// The list of changes of the map, newest first. Refused ones are there when a person asks for them.

import { cell_text } from "./cell_text.js";
import { explain } from "./glossary.js";
import { has_place } from "./layers.js";
import { clock } from "./time_text.js";

const by_id = (id) => document.getElementById(id);

function words_of(change) {
  if (!change.accepted) return `refused: ${change.reason}`;
  const cells = cell_text({ occupied: change.added, free: change.freed, forgotten: change.forgotten });
  return (change.reason ? `${change.reason}: ` : "") + (cells || "no cells");
}

function origin_of(change) {
  const whose = change.operator ? "by an operator" : `Δ-phase ${change.phase}, ${change.scans} scans, acceptance ${change.acceptance.toFixed(2)}`;
  return change.withdraws ? `takes back ${change.withdraws.map((number) => `M${number}`).join(", ")}` : whose;
}

function place_of(change) {
  if (!has_place(change)) return "";
  const [left, bottom, right, top] = change.box_m;
  return `at ${((left + right) / 2).toFixed(1)}, ${((bottom + top) / 2).toFixed(1)} m; `;
}

function item_of(change, on_pick) {
  const item = document.createElement("li");
  item.dataset.time = change.time;
  item.classList.toggle("refused", !change.accepted);
  const button = document.createElement("button");
  button.type = "button";
  button.setAttribute("aria-pressed", "false");
  const title = document.createElement("b");
  title.textContent = change.accepted ? `M${change.revision}` : "–";
  const what = document.createElement("span");
  what.className = "what";
  what.textContent = words_of(change);
  const time = document.createElement("time");
  time.textContent = clock(change.time);
  const why = document.createElement("span");
  why.className = "why";
  why.textContent = place_of(change) + origin_of(change);
  for (const [element, term] of [[title, "revision"], [what, "cells of a change"], [why, "acceptance index"]]) explain(element, term);
  button.append(title, what, time, why);
  button.addEventListener("click", () => on_pick(change, button));
  item.append(button);
  return item;
}

/// Each before the first one that is not younger than it.
/// `accepted`, `refused`: since the start, the forgotten ones too.
export function add_changes({ changes, accepted, refused }, all, on_pick) {
  const host = by_id("changes");
  for (const change of changes) {
    const older = [...host.children].find((item) => Number(item.dataset.time ?? -Infinity) <= change.time);
    host.insertBefore(item_of(change, on_pick), older ?? null);
  }
  by_id("changes-hint").hidden = all.some((change) => change.accepted);
  by_id("changes-count").textContent = `${accepted} accepted, ${refused} refused`;
}

export function clear_changes() {
  for (const item of document.querySelectorAll("#changes li:not(#changes-hint)")) item.remove();
  by_id("changes-hint").hidden = false;
  by_id("changes-count").textContent = "";
}

export function mark_picked(button) {
  for (const other of document.querySelectorAll("#changes button")) other.setAttribute("aria-pressed", String(other === button));
}

by_id("changes-refused").addEventListener("change", (event) => by_id("changes").classList.toggle("with-refused", event.target.checked));
