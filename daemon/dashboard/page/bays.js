// SPDX-License-Identifier: Apache-2.0
// The table of bays: what stands in each and how old that is, with outlines on the map. Asked for every two seconds where there are any; a run that
// is over has none.

import { ink_of } from "./canvas.js";
import { explain } from "./glossary.js";
import { clock, span_of } from "./time_text.js";

const ASK_EVERY_MS = 2000;
const ASK_WHERE_NONE_MS = 30000;
const HURRIES_MS = 20000;  // a bay that was drawn is judged from the next scan on: the first answer may be without it
const INK_OF = { full: "--red", partly: "--orange", empty: "--green", unknown: "--soft" };

export const NAMED_FROM = 12;  // pixels a metre: below, names would hide what they name

const by_id = (id) => document.getElementById(id);
const dashes_of = (state, is_remembered = false) => (state === "unknown" || is_remembered ? [3, 3] : []);

export class Bays {
  /// `on_pick(bay or null)`: by a click; `on_news()`: there is another list.
  constructor(model, on_pick, on_news) {
    this.model = model;
    this.on_pick = on_pick;
    this.on_news = on_news;
    this.asked = -Infinity;  // ms
    this.hurries_until = -Infinity;  // ms
    model.bays = [];
    setInterval(() => this.ask(), ASK_EVERY_MS);
  }

  clear() {
    this.asked = -Infinity;
    this.model.bays = [];
    this.model.picked_bay = null;
    by_id("bays-box").hidden = true;
  }

  /// There are others now, or will be in a moment.
  hurry() {
    this.asked = -Infinity;
    this.hurries_until = performance.now() + HURRIES_MS;
    this.ask();
  }

  async ask() {
    const wait_ms = this.model.bays.length || performance.now() < this.hurries_until ? 0 : ASK_WHERE_NONE_MS;
    if (this.model.run || !this.model.status || document.hidden || performance.now() < this.asked + wait_ms) return;
    this.asked = performance.now();
    try {
      const answer = await fetch("/api/bays", { signal: AbortSignal.timeout(ASK_EVERY_MS) });
      if (!answer.ok) return;
      this.model.bays = (await answer.json()).bays;
      this.list();
      this.on_news();
    } catch {
      this.asked = -Infinity;  // again in a moment, where there was none before too
    }
  }

  list() {
    const { bays, picked_bay } = this.model, full = bays.filter((bay) => bay.state === "full").length;
    by_id("bays-box").hidden = !bays.length;
    by_id("bays-count").textContent = `${full} of ${bays.length} full`;
    const focused = document.activeElement?.dataset?.bay;
    by_id("bays").replaceChildren(...bays.map((bay) => this.row_of(bay, bay.bay === picked_bay)));
    if (focused !== undefined) by_id("bays").querySelector(`[data-bay="${CSS.escape(focused)}"]`)?.focus();
  }

  row_of(bay, is_picked) {
    const row = document.createElement("tr"), button = document.createElement("button");
    button.type = "button";
    button.dataset.bay = bay.bay;
    button.textContent = bay.bay;
    button.title = bay.name ?? "";
    button.setAttribute("aria-pressed", String(is_picked));
    button.addEventListener("click", () => {
      this.model.picked_bay = is_picked ? null : bay.bay;
      this.list();
      this.on_pick(is_picked ? null : bay);
    });
    const cell = (text) => {
      const element = document.createElement("td");
      element.textContent = text;
      row.append(element);
      return element;
    };
    cell("").append(button);
    const state = cell(bay.state);
    state.className = `bay-${bay.state}`;
    explain(state, `bay ${bay.state}`);
    cell(bay.share === null ? "–" : `${Math.round(100 * bay.share)} %`);
    const seen = cell(bay.age_s === null ? "never" : `${span_of(bay.age_s)}${bay.remembered ? " *" : ""}`);
    if (bay.remembered) explain(seen, "bay remembered");
    cell(bay.since === null ? "–" : clock(bay.since));
    return row;
  }
}

export function middle_of(bay) {
  const count = bay.polygon_m.length, sum = bay.polygon_m.reduce(([a, b], [x, y]) => [a + x, b + y], [0, 0]);
  return [sum[0] / count, sum[1] / count];
}

export function trace_polygon(context, view, polygon_m) {
  context.beginPath();
  for (const [x, y] of polygon_m) context.lineTo(...view.to_screen(x, y));
  context.closePath();
}

export function draw_bays(context, view, { bays, picked_bay }) {
  for (const bay of bays ?? []) {
    trace_polygon(context, view, bay.polygon_m);
    context.strokeStyle = context.fillStyle = ink_of(INK_OF[bay.state]);
    context.globalAlpha = 0.18;
    if (bay.state !== "unknown") context.fill();
    context.globalAlpha = 1;
    context.lineWidth = bay.bay === picked_bay ? 3.5 : 1.5;
    context.setLineDash(dashes_of(bay.state, bay.remembered));
    context.stroke();
    context.setLineDash([]);
    if (view.scale < NAMED_FROM) continue;
    const [x, y] = view.to_screen(...middle_of(bay));
    context.fillStyle = ink_of("--text");
    context.textAlign = "center";
    context.fillText(bay.bay, x, y + 4);
    context.textAlign = "start";
  }
}

export function sign_bay(context, state) {
  context.strokeStyle = ink_of(INK_OF[state]);
  context.setLineDash(dashes_of(state));
  context.lineWidth = 1.5;
  context.strokeRect(3, 2, 16, 10);
}
