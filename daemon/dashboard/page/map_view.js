// SPDX-License-Identifier: Apache-2.0
// The map on a canvas: cells in tiles, and the part of it that is shown; mouse, touch and keyboard move it.

import { dots_per_px, ink_of, once_a_frame } from "./canvas.js";

const SIDE = 256; // cells of a tile
export const FREE = 0, OCCUPIED = 1, UNKNOWN = 2;
const LEAST_FREE_PX = 60;  // of the canvas are used whatever covers it
const EDGE_PX = 16;
const LEAST_SCALE = 0.5, MOST_SCALE = 400; // pixels a metre

function rgb(name) {
  const text = ink_of(name);
  return [1, 3, 5].map((at) => parseInt(text.slice(at, at + 2), 16));
}

export class MapView {
  /// `covered`: {top, bottom, right}, the pixels of the canvas that lie under something else.
  constructor(canvas, draw_over, covered = () => ({ top: 0, bottom: 0, right: 0 })) {
    this.covered = covered;
    this.canvas = canvas;
    this.context = canvas.getContext("2d");
    this.draw_over = draw_over;
    this.draw_soon = once_a_frame(() => this.draw());
    this.frame = null;
    this.tiles = new Map();
    this.past = null; // tiles of an older revision, shown in their place
    this.judged = null; // tiles that beams are held against, where that is not the newest map
    this.version = 0;   // of the cells: another number where any may have changed
    this.centre = { x: 0, y: 0 };
    this.scale = 20;
    this.is_fitted = true; // until a person moves the view
    this.aim = null;       // the place that is shown in the middle, until then
    this.follows = false;
    this.on_follow = () => {};
    this.hand = null;    // takes one pointer and keys instead: press, drag, release, key
    this.handed = null;  // the pointer that it has
    this.pointers = new Map();
    new ResizeObserver(() => this.resize()).observe(canvas);
    this.take_pointers();
    this.take_keys();
  }

  // --- cells ---

  set_frame(frame) {
    const is_same = this.frame && ["width", "height", "resolution_m", "origin_m"].every((key) => String(frame[key]) === String(this.frame[key]));
    this.frame = frame;
    this.tiles.clear();
    if (!is_same) {
      this.known = null;
      this.is_fitted = true;
    }
    this.draw_soon();
  }

  tile_at(column, row, tiles) {
    const key = `${Math.floor(column / SIDE)},${Math.floor(row / SIDE)}`;
    let tile = tiles.get(key);
    if (!tile) {
      const picture = document.createElement("canvas");
      picture.width = picture.height = SIDE;
      tile = { column: Math.floor(column / SIDE) * SIDE, row: Math.floor(row / SIDE) * SIDE, picture,
               states: new Uint8Array(SIDE * SIDE).fill(UNKNOWN) };
      tiles.set(key, tile);
    }
    return tile;
  }

  /// A box of cells; it lies in one tile.
  set_cells(box) {
    this.put(box, this.tiles);
    this.grow_known(box);
    if (this.is_fitted) this.fit();
    this.draw_soon();
  }

  tiles_of(boxes) {
    const tiles = new Map();
    for (const box of boxes) this.put(box, tiles);
    return tiles;
  }

  put(box, tiles) {
    const tile = this.tile_at(box.column, box.row, tiles);
    for (let row = 0; row < box.height; ++row) {
      const to = (box.row - tile.row + row) * SIDE + box.column - tile.column;
      tile.states.set(box.states.subarray(row * box.width, (row + 1) * box.width), to);
    }
    this.paint(tile);
    ++this.version;
  }

  /// Beams are held against these tiles; null: against the newest map.
  judge_by(tiles) {
    this.judged = tiles;
    ++this.version;
  }

  grow_known(box) {
    const k = this.known ?? { low_x: Infinity, low_y: Infinity, high_x: -Infinity, high_y: -Infinity };
    this.known = { low_x: Math.min(k.low_x, box.column), low_y: Math.min(k.low_y, box.row),
                   high_x: Math.max(k.high_x, box.column + box.width), high_y: Math.max(k.high_y, box.row + box.height) };
  }

  paint(tile) {
    const colours = [rgb("--map-free"), rgb("--map-occupied"), rgb("--map-unknown")];
    const context = tile.picture.getContext("2d");
    const image = context.createImageData(SIDE, SIDE);
    for (let row = 0; row < SIDE; ++row) {
      for (let column = 0; column < SIDE; ++column) {
        const colour = colours[tile.states[row * SIDE + column]] ?? colours[UNKNOWN];
        const at = 4 * ((SIDE - 1 - row) * SIDE + column);
        image.data[at] = colour[0];
        image.data[at + 1] = colour[1];
        image.data[at + 2] = colour[2];
        image.data[at + 3] = 255;
      }
    }
    context.putImageData(image, 0, 0);
  }

  repaint() {
    for (const tiles of new Set([this.tiles, this.past, this.judged])) for (const tile of tiles?.values() ?? []) this.paint(tile);
    this.draw_soon();
  }

  /// A function of column and row that beams are held against. It remembers the last tile: neighbours come one after another.
  states() {
    const tiles = this.judged ?? this.tiles;
    let tile_column = NaN, tile_row = NaN, tile;
    return (column, row) => {
      const across = Math.floor(column / SIDE), up = Math.floor(row / SIDE);
      if (across !== tile_column || up !== tile_row) {
        [tile_column, tile_row] = [across, up];
        tile = tiles.get(`${across},${up}`);
      }
      return tile ? tile.states[(row - tile.row) * SIDE + column - tile.column] : UNKNOWN;
    };
  }

  /// What the map has at a point: OCCUPIED also where an occupied cell lies within `reach_m`.
  state_near(x, y, reach_m, state_of = this.states()) {
    if (!this.frame) return UNKNOWN;
    const cell_m = this.frame.resolution_m;
    const column = Math.floor((x - this.frame.origin_m[0]) / cell_m);
    const row = Math.floor((y - this.frame.origin_m[1]) / cell_m);
    const reach = Math.ceil(reach_m / cell_m);
    for (let r = row - reach; r <= row + reach; ++r) {
      for (let c = column - reach; c <= column + reach; ++c) {
        if (state_of(c, r) === OCCUPIED) return OCCUPIED;
      }
    }
    return state_of(column, row);
  }

  // --- what is shown ---

  to_screen(x, y) {
    return [this.width / 2 + (x - this.centre.x) * this.scale, this.height / 2 - (y - this.centre.y) * this.scale];
  }
  to_map(px, py) {
    return { x: this.centre.x + (px - this.width / 2) / this.scale, y: this.centre.y - (py - this.height / 2) / this.scale };
  }

  /// The part of the canvas that can be seen: rows from first to last, columns from 0 to wide.
  free_room() {
    const { top, bottom, right } = this.covered();
    const last = Math.max(this.height - bottom, Math.min(this.height, top + LEAST_FREE_PX));
    const first = Math.max(0, Math.min(top, last - LEAST_FREE_PX));
    return { first, last, high: last - first, middle: (first + last) / 2, wide: Math.max(this.width - right, Math.min(this.width, LEAST_FREE_PX)) };
  }

  fit() {
    if (!this.known || !this.frame || !this.width) return;
    const { resolution_m: m, origin_m: [x, y] } = this.frame, room = this.free_room();
    const wide = (this.known.high_x - this.known.low_x) * m, high = (this.known.high_y - this.known.low_y) * m;
    this.scale = Math.min(MOST_SCALE, 0.96 * Math.min(room.wide / wide, room.high / high));
    this.put_in_middle({ x: x + (this.known.low_x + this.known.high_x) * m / 2, y: y + (this.known.low_y + this.known.high_y) * m / 2 });
    this.is_fitted = true;
    this.aim = null;
    this.set_follow(false);
    this.draw_soon();
  }

  put_in_middle({ x, y }) {
    const { middle, wide } = this.free_room();
    this.centre = { x: x + (this.width - wide) / 2 / this.scale, y: y + (middle - this.height / 2) / this.scale };
  }

  move_by(dx_px, dy_px) {
    this.centre = { x: this.centre.x - dx_px / this.scale, y: this.centre.y + dy_px / this.scale };
    this.is_moved();
    this.set_follow(false);
    this.draw_soon();
  }

  /// The point of the map under (px, py) stays there.
  zoom(factor, px = this.width / 2, py = this.height / 2) {
    const held = this.to_map(px, py);
    this.scale = Math.min(MOST_SCALE, Math.max(LEAST_SCALE, this.scale * factor));
    const moved = this.to_map(px, py);
    this.centre = { x: this.centre.x + held.x - moved.x, y: this.centre.y + held.y - moved.y };
    this.is_moved();
    this.draw_soon();
  }

  is_moved() {
    this.is_fitted = false;
    this.aim = null;
  }

  show(x, y) {
    this.is_fitted = false;
    this.aim = { x, y };
    this.put_in_middle(this.aim);
    this.draw_soon();
  }

  /// Moves the map as little as it takes until the place can be seen.
  reveal(x, y) {
    const [px, py] = this.to_screen(x, y), room = this.free_room();
    const into = (at, low, high) => Math.min(Math.max(at, low), high) - at;
    const right = into(px, EDGE_PX, room.wide - EDGE_PX), down = into(py, room.first + EDGE_PX, room.last - EDGE_PX);
    if (right || down) this.move_by(right, down);
  }

  /// What covers the canvas has grown or shrunk. Nothing moves under a hand.
  take_cover() {
    if (this.handed !== null || this.pointers.size) return;
    if (this.is_fitted) this.fit();
    else if (this.aim) this.show(this.aim.x, this.aim.y);
  }

  set_follow(follows) {
    if (this.follows === follows) return;
    this.follows = follows;
    this.on_follow(follows);
  }

  // --- hands ---

  take_pointers() {
    const canvas = this.canvas;
    const at = (event) => ({ x: event.offsetX, y: event.offsetY });
    canvas.addEventListener("wheel", (event) => {
      event.preventDefault();
      this.zoom(Math.exp(-Math.sign(event.deltaY) * Math.min(0.4, Math.abs(event.deltaY) / 400)), event.offsetX, event.offsetY);
    }, { passive: false });
    canvas.addEventListener("pointerdown", (event) => {
      canvas.setPointerCapture(event.pointerId);
      if (this.hand && this.handed === null && !this.pointers.size) {
        this.handed = event.pointerId;
        return this.hand.press(this.to_map(event.offsetX, event.offsetY), at(event));
      }
      this.pointers.set(event.pointerId, at(event));
      canvas.classList.add("dragging");
    });
    canvas.addEventListener("pointermove", (event) => {
      if (this.handed === event.pointerId) return this.hand?.drag(this.to_map(event.offsetX, event.offsetY), at(event));
      if (!this.pointers.has(event.pointerId)) return;
      const before = [...this.pointers.values()];
      const own = this.pointers.get(event.pointerId), now = at(event);
      this.pointers.set(event.pointerId, now);
      if (before.length === 1) return this.move_by(now.x - own.x, now.y - own.y);
      this.pinch(before, [...this.pointers.values()]);
    });
    for (const end of ["pointerup", "pointercancel"]) {
      canvas.addEventListener(end, (event) => {
        if (this.handed === event.pointerId) {
          this.handed = null;
          this.hand?.release();
        }
        this.pointers.delete(event.pointerId);
        if (!this.pointers.size) canvas.classList.remove("dragging");
      });
    }
  }

  pinch([a, b], [c, d]) {
    const middle = (p, q) => ({ x: (p.x + q.x) / 2, y: (p.y + q.y) / 2 });
    const apart = (p, q) => Math.max(1, Math.hypot(p.x - q.x, p.y - q.y));
    const from = middle(a, b), to = middle(c, d);
    this.move_by(to.x - from.x, to.y - from.y);
    this.zoom(apart(c, d) / apart(a, b), to.x, to.y);
  }

  take_keys() {
    const step_px = 60;
    const keys = {
      ArrowLeft: () => this.move_by(step_px, 0), ArrowRight: () => this.move_by(-step_px, 0),
      ArrowUp: () => this.move_by(0, step_px), ArrowDown: () => this.move_by(0, -step_px),
      "+": () => this.zoom(1.25), "=": () => this.zoom(1.25), "-": () => this.zoom(0.8),
      f: () => this.fit(), 0: () => this.fit(), r: () => this.set_follow(!this.follows),
    };
    this.canvas.addEventListener("keydown", (event) => {
      const act = keys[event.key];
      if (event.ctrlKey || event.metaKey || event.altKey) return;
      if (this.hand?.key(event.key)) return event.preventDefault();
      if (!act) return;
      event.preventDefault();
      act();
    });
  }

  // --- drawing ---

  resize() {
    const { clientWidth, clientHeight } = this.canvas;
    const dots = dots_per_px();
    [this.width, this.height] = [clientWidth, clientHeight];
    this.canvas.width = Math.round(clientWidth * dots);
    this.canvas.height = Math.round(clientHeight * dots);
    this.dots = dots;
    this.take_cover();
    this.draw();
  }

  draw() {
    if (!this.width) return;
    const context = this.context;
    context.setTransform(this.dots, 0, 0, this.dots, 0, 0);
    context.clearRect(0, 0, this.width, this.height);
    if (!this.frame) return;
    const m = this.frame.resolution_m;
    context.imageSmoothingEnabled = m * this.scale * this.dots < 1;
    for (const tile of (this.past ?? this.tiles).values()) {
      const [left, bottom] = this.to_screen(this.frame.origin_m[0] + tile.column * m, this.frame.origin_m[1] + tile.row * m);
      const side = SIDE * m * this.scale;
      if (left > this.width || bottom < 0 || left + side < 0 || bottom - side > this.height) continue;
      context.drawImage(tile.picture, left, bottom - side, side, side);
    }
    this.draw_over(context, this);
  }
}
