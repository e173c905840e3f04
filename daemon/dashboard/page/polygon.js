// SPDX-License-Identifier: Apache-2.0
// A polygon under a person's hand: corners are set one by one, dragged, taken away, and put in between. Metres; knows no
// canvas.

const to_cm = (value) => Math.round(100 * value) / 100;

export class Polygon {
  /// `corners`: [x, y] each, in order.
  constructor(corners = []) {
    this.corners = corners.map(([x, y]) => [x, y]);
    this.is_closed = this.corners.length >= 3;
    this.held = null;  // index of the corner that is moved by drag and keys
  }

  corner_near({ x, y }, reach_m) {
    const far = this.corners.map(([cx, cy]) => Math.hypot(cx - x, cy - y)), least = Math.min(...far);
    return least <= reach_m ? far.indexOf(least) : null;
  }

  /// The side whose middle lies there: that of its first corner.
  side_near({ x, y }, reach_m) {
    const at = this.corners.findIndex(([ax, ay], i) => {
      const [bx, by] = this.corners[(i + 1) % this.corners.length];
      return Math.hypot((ax + bx) / 2 - x, (ay + by) / 2 - y) <= reach_m;
    });
    return this.is_closed && at >= 0 ? at : null;
  }

  /// Of an open one: another corner, or its end at the first one. Of a closed one: a corner is held, a side is bent.
  press(point, reach_m) {
    const near = this.corner_near(point, reach_m), side = this.side_near(point, reach_m);
    if (near !== null) {
      if (!this.is_closed && near === 0 && this.close()) return;
      this.held = near;
    } else if (side !== null) {
      this.insert(side + 1, point);
    } else if (this.is_closed) {
      this.held = null;
    } else {
      this.insert(this.corners.length, point);
    }
  }

  insert(at, { x, y }) {
    this.corners.splice(at, 0, [to_cm(x), to_cm(y)]);
    this.held = at;
  }

  move_held({ x, y }) { if (this.held !== null) this.corners[this.held] = [to_cm(x), to_cm(y)]; }

  shift_held(dx, dy) {
    if (this.held === null) return false;
    const [x, y] = this.corners[this.held];
    this.move_held({ x: x + dx, y: y + dy });
    return true;
  }

  close() {
    if (this.corners.length < 3) return false;
    this.is_closed = true;
    this.held = null;
    return true;
  }

  /// The held corner, or the last one; two that are left are open again.
  remove() {
    this.corners.splice(this.held ?? this.corners.length - 1, 1);
    this.held = null;
    if (this.corners.length < 3) this.is_closed = false;
  }
}

export const text_of = (corners) => corners.map(([x, y]) => `${x} ${y}`).join("; ");

/// What a person has typed, "x y; x y; …"; null where that is no list of corners.
export function corners_of(text) {
  const corners = text.split(";").map((one) => one.trim()).filter(Boolean).map((one) => one.split(/[\s,]+/).map(Number));
  return corners.every((corner) => corner.length === 2 && corner.every(Number.isFinite)) ? corners : null;
}
