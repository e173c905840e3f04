// SPDX-License-Identifier: Apache-2.0
// M_0 … M_K on the map: a slider walks through them, the cells of a Δ are marked, and a Δ can be undone.

import { cell_text } from "./cell_text.js";
import { cells_of } from "./connection.js";

const NOTHING = "no cells: nothing to show";

const by_id = (id) => document.getElementById(id);

export async function fetched(address) {
  const answer = await fetch(address, { signal: AbortSignal.timeout(10000) });
  if (!answer.ok) throw new Error((await answer.text()).trim());
  return answer;
}

/// The boxes of /api/revision/K/cells.
export function boxes_in(buffer) {
  const view = new DataView(buffer), boxes = [];
  for (let at = 0; at < buffer.byteLength;) {
    const size = view.getUint32(at, true);
    boxes.push(cells_of(new DataView(buffer, at + 4, size)));
    at += 4 + size;
  }
  return boxes;
}

function words_of(number, changes) {
  if (number === 0) return "the first map";
  const count = (state) => changes.filter(([, , , after]) => after === state).length;
  return cell_text({ occupied: count(1), free: count(0), forgotten: count(2) }) || NOTHING;
}

export class History {
  constructor(view, model, row) {
    this.view = view;
    this.model = model;
    this.row = row;
    this.slider = by_id("history-slider");
    this.undo = by_id("history-undo");
    this.number = null; // the revision that is shown; null: the newest, as it comes
    this.asked = 0;
    by_id("history").addEventListener("click", () => (this.is_open ? this.close() : this.show(this.newest)));
    by_id("history-close").addEventListener("click", () => this.close());
    by_id("history-before").addEventListener("click", () => this.set_before(!this.model.is_before));
    this.slider.addEventListener("input", () => this.show(Number(this.slider.value)));
    this.undo.addEventListener("click", () => this.ask_undo());
    by_id("history-bar").addEventListener("keydown", (event) => { if (event.key === "Escape") this.close(); });
  }

  get is_open() { return this.number !== null; }
  get newest() { return Math.max(this.model.status?.newest_revision ?? 0, this.model.revision ?? 0); }
  get oldest() { return this.model.run?.first_revision ?? 0; }

  allow_undo(is_allowed) { this.undo.hidden = !is_allowed; }

  /// A newer revision may have come, by an undo too.
  update() {
    this.slider.min = this.oldest;
    this.slider.max = this.newest;
    if (this.is_open) this.tell();
    by_id("history").disabled = !this.model.status && !this.model.run?.has_history;
  }

  /// The map after Δ `number`, its cells marked. Only the newest wish counts: the slider is faster than answers.
  async show(number) {
    const asked = ++this.asked;
    this.number = number;
    this.model.is_before = false;
    this.words = "…";
    this.update();
    this.slider.value = number;
    by_id("history-bar").hidden = false;
    by_id("history").setAttribute("aria-pressed", "true");
    try {
      const wanted = [number, Math.max(this.oldest, number - 1)].map((k) => fetched(`/api/revision/${k}/cells`).then((answer) => answer.arrayBuffer()));
      const [after, before, changes] = await Promise.all([...wanted, fetched(`/api/revision/${number}/changes`).then((answer) => answer.json())]);
      if (asked !== this.asked) return;
      this.maps = [after, before].map((buffer) => this.view.tiles_of(boxes_in(buffer)));
      this.model.delta = changes.cells;
      this.words = words_of(number, changes.cells);
    } catch (error) {
      if (asked !== this.asked) return;
      this.maps = null;
      this.model.delta = null;
      this.words = error.message;
    }
    this.tell();
    this.put();
  }

  set_before(is_before) {
    this.model.is_before = is_before;
    this.put();
  }

  put() {
    this.view.past = this.maps?.[this.model.is_before ? 1 : 0] ?? null;
    by_id("history-before").setAttribute("aria-pressed", String(this.model.is_before));
    by_id("history-before").disabled = this.undo.disabled = !this.maps || this.number === this.oldest;
    this.undo.textContent = `Undo M${this.number}`;
    this.view.draw_soon();
  }

  tell() {
    const text = `M${this.number} of M${this.newest}: ${this.words}`, host = by_id("history-text");
    if (host.textContent !== text) host.textContent = text;
  }

  close() {
    ++this.asked;
    this.number = this.maps = this.model.delta = null;
    by_id("history-bar").hidden = true;
    by_id("history").setAttribute("aria-pressed", "false");
    this.view.past = this.view.judged;
    this.view.draw_soon();
  }

  ask_undo() {
    const revision = this.number;
    this.row.ask(`Undo M${revision}? Its cells become what they were before it, where nothing has changed them since.`,
                 [[`Undo M${revision}`, () => this.row.run({ command: "undo", revision }, `undoing M${revision} …`)]]);
  }
}
