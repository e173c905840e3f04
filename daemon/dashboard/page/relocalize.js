// SPDX-License-Identifier: Apache-2.0
// Says where the robot is: pressed on the map where it stands, dragged to where it looks; the newest scan is drawn from
// there all the while. By keys: arrows shift it, comma and full stop turn it, Enter confirms.

import { beam_words, share_that_fits } from "./beams.js";
import { placed_ends } from "./layers.js";

const LEAST_DRAG_PX = 8; // below, the heading stays
const STEP_M = 0.1, STEP_RAD = Math.PI / 36;

const degrees = (angle) => ((Math.round(angle * 180 / Math.PI) % 360) + 360) % 360;
const words_of = ({ x, y, heading }) => `${x.toFixed(2)}, ${y.toFixed(2)} m, ${degrees(heading)}°`;

export class Relocalize {
  constructor(view, model, row, on_change) {
    this.view = view;
    this.model = model;
    this.row = row;
    this.on_change = on_change;
  }

  get is_on() { return this.view.hand === this; }

  begin() {
    this.view.hand?.end?.();  // whoever else has the map
    this.view.hand = this;
    this.has_asked = false;
    this.view.set_follow(false);
    this.view.canvas.focus();
    this.row.ask("Press where the robot is, drag to where it looks; or arrows, comma and full stop.", [], () => this.end());
    this.on_change();
  }

  end() {
    if (this.is_on) this.view.hand = null;
    this.model.wish = null;
    this.row.hide();
    this.on_change();
    this.view.draw_soon();
  }

  set_wish(wish) {
    const ends = placed_ends(this.model.scan, wish);
    this.model.wish = { ...wish, ends, words: beam_words(this.view, wish, ends) };
    this.tell();
    this.view.draw_soon();
  }

  /// A newer scan has come: it may fit better or worse.
  update() { if (this.model.wish) this.set_wish(this.model.wish); }

  tell() {
    const share = share_that_fits(this.model.wish.words);
    const fit = share === null ? "no scan yet" : `${Math.round(100 * share)} % of the beams fit the map`;
    const text = `${words_of(this.model.wish)}: ${fit}`;
    if (this.has_asked) return this.row.set_text(text);
    this.row.ask(text, [["Relocalize here", () => this.confirm()]], () => this.end());
    this.has_asked = true;
  }

  confirm() {
    const { x, y, heading } = this.model.wish;
    this.end();
    this.row.run({ command: "relocalize", x_m: x, y_m: y, heading_deg: heading * 180 / Math.PI }, "telling the robot where it is …");
  }

  // --- what the map hands over ---

  press(point, px) {
    this.pressed = { ...point, px };
    this.set_wish({ ...point, heading: this.model.wish?.heading ?? this.model.pose?.heading_rad ?? 0 });
  }
  drag(point, px) {
    const { x, y, px: from } = this.pressed;
    if (Math.hypot(px.x - from.x, px.y - from.y) < LEAST_DRAG_PX) return;
    this.set_wish({ x, y, heading: Math.atan2(point.y - y, point.x - x) });
  }
  release() { if (this.model.wish) this.view.reveal(this.model.wish.x, this.model.wish.y); }

  /// Whether the key was for this.
  key(name) {
    const step = { ArrowLeft: [-STEP_M, 0, 0], ArrowRight: [STEP_M, 0, 0], ArrowUp: [0, STEP_M, 0], ArrowDown: [0, -STEP_M, 0],
                   ",": [0, 0, STEP_RAD], ".": [0, 0, -STEP_RAD] }[name];
    if (name === "Escape") this.end();
    else if (name === "Enter" && this.model.wish) this.confirm();
    else if (!step) return false;
    else {
      const pose = this.model.pose, centre = this.view.centre;
      const from = this.model.wish ?? (pose ? { x: pose.x_m, y: pose.y_m, heading: pose.heading_rad } : { ...centre, heading: 0 });
      this.set_wish({ x: from.x + step[0], y: from.y + step[1], heading: from.heading + step[2] });
      this.release();
    }
    return true;
  }
}
