// SPDX-License-Identifier: Apache-2.0
// Bays and zones are drawn on the map and sent to the daemon, which checks them, writes their file and takes them live
// (docs/api.md, bay and zone).

import { ink_of } from "./canvas.js";
import { fetched } from "./history.js";
import { corners_of, Polygon, text_of } from "./polygon.js";

const REACH_PX = 12;  // of a corner
const STEP_M = 0.05;
// Keys of each kind's file, and the field of the page that has each.
const KINDS = {
  bay: { list: "bays", id: "id", polygon: "polygon", words: { name: "drawing-name", stationId: "drawing-station" } },
  zone: { list: "zones", id: "zoneId", polygon: "vertices", words: { zoneType: "drawing-type", zoneDescriptor: "drawing-name", maximumSpeed: "drawing-speed" } },
};

const by_id = (id) => document.getElementById(id);

export class Drawing {
  /// `on_saved()`: other places are in force.
  constructor(view, model, row, on_saved) {
    Object.assign(this, { view, model, row, on_saved });
    this.site = null;  // of /api/site, when it was read last
    this.kind = "bay";
    this.of = "";      // id of the place that is changed; empty: a new one
    model.drawing = null;
    by_id("draw").addEventListener("click", () => (this.is_on ? this.end() : this.begin()));
    by_id("drawing-close").addEventListener("click", () => this.end());
    by_id("drawing-save").addEventListener("click", () => this.save());
    by_id("drawing-remove").addEventListener("click", () => this.ask_remove());
    by_id("drawing-place").addEventListener("change", (event) => this.choose(event.target.value));
    by_id("drawing-type").addEventListener("change", () => this.show_fields());
    by_id("drawing-corners").addEventListener("change", () => this.take_text());
    by_id("drawing").addEventListener("keydown", (event) => { if (event.key === "Escape") this.end(); });
  }

  get is_on() { return this.view.hand === this; }
  get list() { return this.site[KINDS[this.kind].list]; }

  async begin() {
    if (!await this.read()) return;
    this.view.hand?.end?.();  // whoever else has the map
    this.view.hand = this;
    this.view.set_follow(false);
    by_id("drawing").hidden = false;
    by_id("draw").setAttribute("aria-pressed", "true");
    this.choose(this.site.bays.file || !this.site.zones.file ? "bay:" : "zone:");
    by_id("drawing-place").focus();
  }

  end() {
    if (this.is_on) this.view.hand = null;
    this.model.drawing = null;
    by_id("drawing").hidden = true;
    by_id("draw").setAttribute("aria-pressed", "false");
    this.view.draw_soon();
  }

  /// False, and told, where the daemon does not answer.
  async read() {
    try {
      this.site = await (await fetched("/api/site")).json();
    } catch (error) {
      this.row.tell(`Bays and zones cannot be read: ${error.message}`, "bad");
      return false;
    }
    const option = (value, text) => Object.assign(document.createElement("option"), { value, textContent: text });
    const known = (kind) => this.site[KINDS[kind].list].places.map((place) => option(`${kind}:${place[KINDS[kind].id]}`, `${kind} ${place[KINDS[kind].id]}`));
    by_id("drawing-place").replaceChildren(option("bay:", "new bay"), option("zone:", "new zone"), ...known("bay"), ...known("zone"));
    return true;
  }

  /// "bay:B4" is that one, "bay:" a new one.
  choose(value) {
    const at = value.indexOf(":"), { id, polygon, words } = KINDS[this.kind = value.slice(0, at)];
    this.of = value.slice(at + 1);
    const place = this.list.places.find((one) => one[id] === this.of);
    if (!place) this.of = "";
    by_id("drawing-place").value = `${this.kind}:${this.of}`;
    by_id("drawing-id").value = this.of;
    for (const [key, field] of Object.entries(words)) by_id(field).value = place?.[key] ?? (key === "zoneType" ? "BLOCKED" : "");
    this.set_polygon(new Polygon(place?.[polygon] ?? []));
    this.show_fields();
    if (!this.list.file) this.row.tell(`'${KINDS[this.kind].list}.file' names no file: set it to one that holds '${KINDS[this.kind].list}:', and restart the daemon.`, "warn", 20000);
    else if (place) this.view.reveal(...place[polygon][0]);
    else this.row.tell("Click the corners on the map, the first one again to close; then drag what is not right. Delete takes a corner away.", "none", 20000);
  }

  show_fields() {
    for (const element of by_id("drawing").querySelectorAll("[data-of]")) element.hidden = element.dataset.of !== this.kind;
    by_id("drawing-speed").parentElement.hidden = this.kind !== "zone" || by_id("drawing-type").value !== "SPEED_LIMIT";
    by_id("drawing-remove").hidden = !this.of;
    by_id("drawing-save").disabled = by_id("drawing-remove").disabled = !this.list.file;
  }

  set_polygon(polygon) {
    this.model.drawing = polygon;
    this.show();
  }

  show() {
    by_id("drawing-corners").value = text_of(this.model.drawing.corners);
    this.view.draw_soon();
  }

  take_text() {
    const corners = corners_of(by_id("drawing-corners").value);
    if (!corners) return this.row.tell("Corners are written as x y; x y; x y, in metres of the map.", "warn");
    this.set_polygon(new Polygon(corners));
  }

  /// In the keys of its file; what is empty is not there.
  place() {
    const { id, polygon, words } = KINDS[this.kind], place = { [id]: by_id("drawing-id").value.trim() };
    for (const [key, field] of Object.entries(words)) {
      const word = by_id(field).value.trim();
      if (word && (key !== "maximumSpeed" || place.zoneType === "SPEED_LIMIT")) place[key] = word;
    }
    return { ...place, [polygon]: this.model.drawing.corners };
  }

  async save() {
    if (!by_id("drawing-id").value.trim()) {
      by_id("drawing-id").focus();
      return this.row.tell(`A ${this.kind} needs an id of its own.`, "warn");
    }
    const place = this.place();
    await this.send({ place }, place[KINDS[this.kind].id]);
  }

  ask_remove() {
    this.row.ask(`Take ${this.kind} ${this.of} away?`, [["Take away", () => this.send({}, "")]]);
  }

  /// What was drawn stays where the daemon refuses it; the list is read again, for somebody else may have drawn.
  async send(what, id) {
    const { kind } = this, request = { command: kind, version: this.list.version, ...(this.of && { of: this.of }), ...what };
    by_id("drawing-save").disabled = by_id("drawing-remove").disabled = true;  // one after another
    const answer = await this.row.run(request, "checking and writing …");
    if (answer.ok) this.on_saved();
    const is_read = this.is_on && await this.read();
    if (is_read && answer.ok) return this.choose_quietly(`${kind}:${id}`);
    by_id("drawing-place").value = `${kind}:${this.of}`;
    this.show_fields();
  }

  /// The daemon's answer stays in sight.
  choose_quietly(value) {
    const { textContent } = this.row.text, { level } = this.row.host.dataset;
    this.choose(value);
    this.row.tell(textContent, level, 20000);
  }

  // --- what the map hands over ---

  press(point) {
    this.model.drawing.press(point, REACH_PX / this.view.scale);
    this.show();
  }
  drag(point) {
    this.model.drawing.move_held(point);
    this.show();
  }
  release() {}

  /// Whether the key was for this.
  key(name) {
    const polygon = this.model.drawing;
    const step = { ArrowLeft: [-STEP_M, 0], ArrowRight: [STEP_M, 0], ArrowUp: [0, STEP_M], ArrowDown: [0, -STEP_M] }[name];
    if (name === "Escape") return this.end(), true;
    if (name === "Enter") polygon.close();
    else if (name === "Delete" || name === "Backspace") polygon.remove();
    else if (!step || !polygon.shift_held(...step)) return false;
    this.show();
    return true;
  }
}

/// No layer: it cannot be switched off.
export function draw_drawing(context, view, { drawing }) {
  if (!drawing?.corners.length) return;
  const corners = drawing.corners.map(([x, y]) => view.to_screen(x, y));
  context.strokeStyle = context.fillStyle = ink_of("--accent");
  context.lineWidth = 2.5;
  context.setLineDash(drawing.is_closed ? [] : [6, 4]);
  context.beginPath();
  for (const corner of corners) context.lineTo(...corner);
  if (drawing.is_closed) context.closePath();
  context.stroke();
  context.setLineDash([]);
  corners.forEach(([x, y], i) => {
    const side = i === drawing.held || (i === 0 && !drawing.is_closed) ? 12 : 8;
    context.fillRect(x - side / 2, y - side / 2, side, side);
    const [bx, by] = corners[(i + 1) % corners.length];
    if (drawing.is_closed) context.strokeRect((x + bx) / 2 - 3, (y + by) / 2 - 3, 6, 6);
  });
}
