// SPDX-License-Identifier: Apache-2.0
// The page for a run that is over (`deltamap view`): a slider through its time. What was at a time is fetched as the
// messages that a live page would have had then; the map as the revision that the pose was computed on.

import { boxes_in, fetched } from "./history.js";
import { clock } from "./time_text.js";

const STEP_S = 0.1;
const FRAME_S = 0.1;    // between two moments while it plays
const MOST_MAPS = 24;   // revisions that are kept

const by_id = (id) => document.getElementById(id);
const minutes = (time_s) => `${Math.floor(time_s / 60)}:${String(Math.floor(time_s % 60)).padStart(2, "0")}`;

/// Messages that stand one after another, each after the number of its bytes, as the live stream would have brought them.
export function messages_in(buffer) {
  const view = new DataView(buffer), messages = [];
  for (let at = 0; at < buffer.byteLength;) {
    const size = view.getUint32(at, true), bytes = buffer.slice(at + 4, at + 4 + size);
    messages.push(new Uint8Array(bytes)[0] === 0x7b ? new TextDecoder().decode(bytes) : bytes);
    at += 4 + size;
  }
  return messages;
}

export class Run {
  /// `take`: of a message, as the connection has it. `on_time`: another time is shown.
  constructor(view, model, take, on_time) {
    Object.assign(this, { view, model, take, on_time });
    this.kind = null;    // of hello; null: a live daemon
    this.told = null;    // newest message `run`
    this.wanted = null;  // time that is to be shown
    this.is_busy = false;
    this.follows_end = true;  // until a person says otherwise
    this.maps = new Map();
    this.on_walk = () => {};
    this.slider = by_id("run-slider");
    this.slider.step = STEP_S;
    this.slider.addEventListener("input", () => this.walk(this.told.from + Number(this.slider.value)));
    by_id("run-play").addEventListener("click", () => this.play(!this.timer));
    by_id("run-before").addEventListener("click", () => this.jump(-1));
    by_id("run-next").addEventListener("click", () => this.jump(1));
  }

  get is_open() { return this.kind !== null; }

  /// A stream has begun: `run` of its hello, or null.
  begin(run) {
    this.play(false);
    this.kind = run?.kind ?? null;
    this.model.run = run;
    if (run) document.body.dataset.run = run.kind; else delete document.body.dataset.run;
    this.model.until = this.told = this.wanted = this.noted = null;
    this.follows_end = true;
    this.maps.clear();
    this.view.judge_by(null);
    by_id("run-bar").hidden = true;
  }

  /// How far the run has been read.
  show(told) {
    this.told = told;
    const has_scans = told.from !== null;
    by_id("run-bar").hidden = !has_scans;
    const note = told.complete ? told.note : `reading: ${Math.floor(100 * told.done)} %`;
    if (note !== this.noted) by_id("run-note").textContent = this.noted = note;  // what a jump has told stays
    if (!has_scans) return;
    this.slider.max = (Math.ceil((told.to - told.from) / STEP_S) * STEP_S).toFixed(1);
    if (this.follows_end) this.aim(told.to); else this.tell();
  }

  /// By slider or by playing: a revision that is looked at goes along.
  walk(time) {
    this.go(time);
    this.on_walk(this.wanted);
  }

  /// To the next event of the chosen kind (1), or to the one before (-1).
  async jump(direction) {
    const note = by_id("run-note"), kind = by_id("run-kind").value;
    try {
      const events = await (await fetched("/api/events")).json();
      const ahead = events.filter((event) => (!kind || event.kind === kind) && direction * (event.time - this.wanted) > STEP_S / 2);
      const event = direction > 0 ? ahead[0] : ahead[ahead.length - 1];
      if (event) this.walk(event.time);
      note.textContent = event ? `${event.kind}: ${event.words}` : `no ${kind || "event"} ${direction > 0 ? "behind" : "before"} this`;
    } catch (error) {
      note.textContent = error.message;
    }
  }

  /// A person's wish.
  go(time) {
    this.follows_end = false;
    this.aim(time);
  }

  aim(time) {
    if (!this.told || this.told.from === null) return;
    this.wanted = Math.min(this.told.to, Math.max(this.told.from, time));
    this.slider.value = this.wanted - this.told.from;
    this.tell();
    this.fetch();
  }

  tell() {
    const { from, to } = this.told, passed = this.wanted - from;
    by_id("run-time").textContent = `${clock(this.wanted)} · ${minutes(passed)} of ${minutes(to - from)}`;
    this.slider.setAttribute("aria-valuetext", by_id("run-time").textContent);
  }

  /// Only the newest wish counts: the slider is faster than answers.
  async fetch() {
    if (this.is_busy) return;
    this.is_busy = true;
    for (let time = null; time !== this.wanted;) {
      time = this.wanted;
      try {
        const moment = await (await fetched(`/api/moment?time=${time.toFixed(3)}`)).arrayBuffer();
        this.model.until = time;
        this.model.scan = null;
        for (const message of messages_in(moment)) this.take(message);
        await this.put_map();
        this.on_time(time);
      } catch (error) {
        by_id("run-note").textContent = error.message;
      }
    }
    this.is_busy = false;
  }

  /// The map that the pose was computed on, unless a person looks at another one.
  async put_map(is_free = !this.model.delta) {
    const number = this.model.pose.revision;
    this.view.judge_by(number === this.told.revision ? null : await this.map_of(number));
    if (is_free) this.view.past = this.view.judged;
    this.view.draw_soon();
  }

  async map_of(number) {
    if (!this.maps.has(number)) {
      const boxes = boxes_in(await (await fetched(`/api/revision/${number}/cells`)).arrayBuffer());
      if (this.maps.size >= MOST_MAPS) this.maps.delete(this.maps.keys().next().value);
      this.maps.set(number, this.view.tiles_of(boxes));
    }
    return this.maps.get(number);
  }

  play(plays) {
    clearInterval(this.timer);
    this.timer = plays ? setInterval(() => this.advance(), 1000 * FRAME_S) : null;
    if (plays && this.wanted >= this.told.to) this.go(this.told.from);
    by_id("run-play").setAttribute("aria-pressed", String(plays));
    by_id("run-play").textContent = plays ? "Pause" : "Play";
  }

  advance() {
    if (this.is_busy) return;
    if (this.wanted >= this.told.to) return this.play(false);
    this.walk(this.wanted + FRAME_S * Number(by_id("run-speed").value));
  }
}
