// SPDX-License-Identifier: Apache-2.0
// The list of things, newest first: what has come, gone and moved. Asked for whenever the map has another revision; of a
// run that is over, whenever another second of it is shown.

import { explain } from "./glossary.js";
import { clock, span_of } from "./time_text.js";

const ASK_EVERY_MS = 2000;
const MOST_LISTED = 50;

const by_id = (id) => document.getElementById(id);

const is_there = (thing) => thing.kind !== "taken back" && thing.kind !== "joined";
export const outline_of = (thing) => thing.at ?? thing.from;

export class Things {
  /// `on_pick(thing or null)`.
  constructor(model, on_pick) {
    this.model = model;
    this.on_pick = on_pick;
    this.revision = null;  // that the list is of
    this.asked = 0;        // ms
    model.things = [];
    setInterval(() => this.ask_where_due(), ASK_EVERY_MS / 2);
  }

  clear() {
    this.revision = null;
    this.model.things = [];
    this.model.picked_thing = null;
    by_id("things-box").hidden = true;
  }

  async ask_where_due() {
    const shown = this.model.run ? this.model.pose?.time : null;  // of a run
    const newest = shown ? Math.floor(shown) : this.model.run ? null : this.model.revision ?? this.model.status?.newest_revision ?? null;
    if (newest === null || newest === this.revision || (!shown && performance.now() - this.asked < ASK_EVERY_MS)) return;
    this.asked = performance.now();
    try {
      const answer = await fetch(shown ? `/api/things?time=${shown}` : "/api/things", { signal: AbortSignal.timeout(10000) });
      if (!answer.ok) return;
      this.model.things = (await answer.json()).things.filter(is_there);
      this.revision = newest;
      this.list();
    } catch { /* asked again in a moment */ }
  }

  list() {
    const { things } = this.model, now = this.model.pose?.time ?? Date.now() / 1000;
    const newest = [...things].sort((a, b) => b.last_seen - a.last_seen || b.thing - a.thing).slice(0, MOST_LISTED);
    this.model.picked_thing = things.find((thing) => thing.thing === this.model.picked_thing?.thing) ?? null;
    by_id("things-box").hidden = !things.length;
    by_id("things-count").textContent = String(things.length);
    by_id("things").replaceChildren(...newest.map((thing) => this.item_of(thing, now)));
    this.on_pick(this.model.picked_thing, false);
  }

  item_of(thing, now) {
    const item = document.createElement("li"), button = document.createElement("button");
    button.type = "button";
    button.setAttribute("aria-pressed", String(this.model.picked_thing === thing));
    const part = (name, className, text) => {
      const element = document.createElement(name);
      element.className = className;
      element.textContent = text;
      return element;
    };
    const { sides_seen, sides_assumed = [] } = outline_of(thing);
    const unseen = sides_seen.filter((seen) => !seen).length;
    const not_seen = `${unseen} sides not seen${sides_assumed.includes(true) ? ", assumed" : ""}; `;
    const time = part("time", "", `${span_of(now - thing.last_seen)} ago`);
    time.dateTime = new Date(1000 * thing.last_seen).toISOString();
    const title = part("b", "", String(thing.thing)), what = part("span", "what", thing.words);
    button.append(title, what, time,
                  part("span", "why", `${thing.at && unseen ? not_seen : ""}first at ${clock(thing.first_seen)}, M${thing.revisions[0]}`));
    for (const element of [title, what]) explain(element, "thing");
    button.addEventListener("click", () => {
      this.model.picked_thing = this.model.picked_thing === thing ? null : thing;
      for (const other of by_id("things").querySelectorAll("button")) other.setAttribute("aria-pressed", String(other === button && Boolean(this.model.picked_thing)));
      this.on_pick(this.model.picked_thing, true);
    });
    item.append(button);
    return item;
  }
}
