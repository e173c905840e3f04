// SPDX-License-Identifier: Apache-2.0
// What is drawn over the map: one layer a kind of thing, each with its sign in the legend, and a scale bar.

import { beam_words, FITS, NOT_KNOWN, SHORT, THROUGH } from "./beams.js";
import { draw_bays, sign_bay } from "./bays.js";
import { draw_particles, draw_stored, draw_way, sign_particles, sign_stored, sign_way } from "./belief_layers.js";
import { circle, ink_of } from "./canvas.js";
import { explain } from "./glossary.js";
import { draw_zones, sign_zone, ZONES } from "./zones.js";

const OLD_INK = "--soft";  // of what is no longer known to be so
const JUMP_M = 2;      // the path is not joined over such a step
const SIGMAS = 2;      // of the covariance ellipse
const ROBOT_M = 0.25;  // radius
const LEAST_ROBOT_PX = 7;
const MOST_RINGS = 8;
const LEAST_SHARE = 0.005;  // of the belief, of a hypothesis that is drawn

/// A triangle that points ahead, on a disc.
function robot_sign(context, x, y, heading, radius, colour) {
  context.fillStyle = colour;
  circle(context, x, y, radius);
  context.fill();
  context.lineWidth = 1.5;
  context.strokeStyle = ink_of("--card");
  context.stroke();
  context.save();
  context.translate(x, y);
  context.rotate(-heading);
  context.fillStyle = ink_of("--card");
  context.beginPath();
  context.moveTo(0.8 * radius, 0);
  context.lineTo(-0.45 * radius, 0.55 * radius);
  context.lineTo(-0.45 * radius, -0.55 * radius);
  context.fill();
  context.restore();
}

function draw_path(context, view, model) {
  context.strokeStyle = ink_of("--sky");
  context.lineWidth = 2;
  context.globalAlpha = 0.75;
  context.beginPath();
  let last = null;
  const past = model.until == null ? model.samples : model.samples.filter(({ time }) => time <= model.until);
  const points = model.pose ? [...past, model.pose] : past;
  for (const { x_m, y_m } of points) {
    const [px, py] = view.to_screen(x_m, y_m);
    const is_joined = last && Math.hypot(x_m - last.x_m, y_m - last.y_m) < JUMP_M;
    if (is_joined) context.lineTo(px, py); else context.moveTo(px, py);
    last = { x_m, y_m };
  }
  context.stroke();
  context.globalAlpha = 1;
}

/// Where the beams of a scan (cm, robot's frame) would end if the robot were there.
export function placed_ends(scan, { x, y, heading }) {
  const beams = scan?.beams ?? [], cos = Math.cos(heading), sin = Math.sin(heading);
  const ends = new Float32Array(beams.length);
  for (let i = 0; i < beams.length; i += 2) {
    const bx = beams[i] / 100, by = beams[i + 1] / 100;
    ends[i] = x + cos * bx - sin * by;
    ends[i + 1] = y + sin * bx + cos * by;
  }
  return ends;
}

// By what a beam says: a full square, a full disc, a cross, a ring.
const BEAM_SIGNS = {
  [FITS]: ["--green", (c, x, y, size) => c.fillRect(x - size / 2, y - size / 2, size, size)],
  [SHORT]: ["--orange", (c, x, y, size) => { circle(c, x, y, 0.6 * size); c.fill(); }],
  [THROUGH]: ["--blue", (c, x, y, size) => {
    const arm = 0.7 * size;
    c.beginPath();
    for (const side of [-1, 1]) { c.moveTo(x - arm, y - side * arm); c.lineTo(x + arm, y + side * arm); }
    c.stroke();
  }],
  [NOT_KNOWN]: ["--pink", (c, x, y, size) => { circle(c, x, y, 0.55 * size); c.stroke(); }],
};

function sign_beam(context, word) {
  const [ink, draw] = BEAM_SIGNS[word];
  context.fillStyle = context.strokeStyle = ink_of(ink);
  context.lineWidth = 1.75;
  draw(context, 11, 7, 7);
}

/// The words of a scan's beams, found once and kept until a cell of the map changes.
function words_of(view, scan) {
  if (scan.map_version !== view.version) {
    scan.words = beam_words(view, scan, scan.ends);
    scan.map_version = view.version;
  }
  return scan.words;
}

function draw_scan(context, view, model) {
  if (model.scan && !model.wish) draw_ends(context, view, model.scan.ends, words_of(view, model.scan), model.is_old);
}

function draw_ends(context, view, ends, words, is_old = false) {
  const size = Math.max(3, Math.min(7, 0.07 * view.scale));
  context.lineWidth = 1.5;
  for (const [word, [ink, draw]] of Object.entries(BEAM_SIGNS)) {
    context.fillStyle = context.strokeStyle = ink_of(is_old ? OLD_INK : ink);
    words.forEach((own, i) => { if (own === Number(word)) draw(context, ...view.to_screen(ends[2 * i], ends[2 * i + 1]), size); });
  }
}

function each_block(model, kind, act) {
  const { transient } = model;
  if (!transient?.blocks_across) return;
  for (const index of transient[kind]) {
    const column = index % transient.blocks_across, row = Math.floor(index / transient.blocks_across);
    act(transient.origin_m[0] + column * transient.block_m, transient.origin_m[1] + row * transient.block_m, transient.block_m);
  }
}

function hatched(context, x, y, width, height, colour) {
  context.save();
  context.beginPath();
  context.rect(x, y, width, height);
  context.clip();
  context.globalAlpha = 0.35;
  context.fillStyle = colour;
  context.fillRect(x, y, width, height);
  context.globalAlpha = 1;
  context.strokeStyle = colour;
  context.lineWidth = 1.5;
  context.beginPath();
  for (let at = x - height - ((x - height) % 6); at < x + width; at += 6) {
    context.moveTo(at, y + height);
    context.lineTo(at + height, y);
  }
  context.stroke();
  context.restore();
}

function draw_transient(context, view, model) {
  if (model.status?.mapping === "paused") return; // nobody looks after it
  each_block(model, "standing", (x, y, side) => {
    const [px, py] = view.to_screen(x, y + side);
    hatched(context, px, py, side * view.scale, side * view.scale, ink_of("--orange"));
  });
  context.strokeStyle = ink_of("--blue");
  context.lineWidth = 1.5;
  each_block(model, "gone", (x, y, side) => {
    const [px, py] = view.to_screen(x, y + side);
    context.strokeRect(px + 1, py + 1, side * view.scale - 2, side * view.scale - 2);
  });
}

/// A refused change that found nothing has none.
export const has_place = ({ box_m: [left, bottom, right, top] }) => right > left && top > bottom;

const RING_M = 0.15;  // around the changed cells
const LEAST_RING_PX = 20;

/// The newest ones; what lies inside a newer ring has none of its own.
function draw_changes(context, view, model) {
  const shown = model.picked && has_place(model.picked) ? [model.picked] : [];
  for (let i = model.changes.length - 1; i >= 0 && shown.length < MOST_RINGS; --i) {
    if (model.until != null && model.changes[i].time > model.until) continue;
    const [left, bottom, right, top] = model.changes[i].box_m;
    const x = (left + right) / 2, y = (bottom + top) / 2;
    const is_covered = shown.some(({ box_m: [l, b, r, t] }) => x > l - RING_M && x < r + RING_M && y > b - RING_M && y < t + RING_M);
    if (model.changes[i].accepted && has_place(model.changes[i]) && !is_covered) shown.push(model.changes[i]);
  }
  context.strokeStyle = ink_of("--red");
  for (const change of shown) {
    const [left, bottom, right, top] = change.box_m, is_picked = change === model.picked;
    const [x, y] = view.to_screen((left + right) / 2, (bottom + top) / 2);
    const width = Math.max(LEAST_RING_PX, (right - left + 2 * RING_M) * view.scale);
    const height = Math.max(LEAST_RING_PX, (top - bottom + 2 * RING_M) * view.scale);
    context.setLineDash(is_picked ? [] : [5, 4]);
    context.lineWidth = is_picked ? 3.5 : 1.5;
    context.beginPath();
    context.roundRect(x - width / 2, y - height / 2, width, height, Math.min(width, height) / 2);
    context.stroke();
  }
  context.setLineDash([]);
}

function draw_hypothesis(context, view, model) {
  const other = model.pose?.other_hypothesis;
  if (!other || other.share < LEAST_SHARE) return;
  const [x, y] = view.to_screen(other.x_m, other.y_m);
  context.globalAlpha = 0.35 + 0.65 * other.share;
  robot_sign(context, x, y, other.heading_rad, Math.max(LEAST_ROBOT_PX, ROBOT_M * view.scale), ink_of("--pink"));
  context.globalAlpha = 1;
  context.fillStyle = ink_of("--text");
  context.fillText(other.share < 0.01 ? "< 1 %" : `${(100 * other.share).toFixed(0)} %`, x + 12, y - 10);
}

/// Half axes and direction of the ellipse of so many sigmas.
export function ellipse_of({ xx_m2: a, xy_m2: b, yy_m2: c }, sigmas) {
  const middle = (a + c) / 2, root = Math.hypot((a - c) / 2, b);
  return { long: sigmas * Math.sqrt(Math.max(0, middle + root)), short: sigmas * Math.sqrt(Math.max(0, middle - root)),
           angle: 0.5 * Math.atan2(2 * b, a - c) };
}

function draw_robot(context, view, model) {
  const pose = model.pose;
  if (!pose) return;
  const [x, y] = view.to_screen(pose.x_m, pose.y_m);
  const { long, short, angle } = ellipse_of(pose.covariance, SIGMAS);
  context.beginPath();
  context.ellipse(x, y, Math.max(1, long * view.scale), Math.max(1, short * view.scale), -angle, 0, 2 * Math.PI);
  const ink = ink_of(model.is_old ? OLD_INK : "--blue");
  context.globalAlpha = 0.25;
  context.fillStyle = ink;
  context.fill();
  context.globalAlpha = 1;
  context.strokeStyle = ink;
  context.lineWidth = 1.5;
  context.stroke();
  robot_sign(context, x, y, pose.heading_rad, Math.max(LEAST_ROBOT_PX, ROBOT_M * view.scale), ink);
}

const LEAST_CELL_PX = 3;
// By the state that a cell took: filled, hollow, crossed out.
const DELTA_SIGNS = [
  ["--blue", (c, x, y, side) => c.strokeRect(x + 0.75, y + 0.75, side - 1.5, side - 1.5)],
  ["--red", (c, x, y, side) => c.fillRect(x, y, side, side)],
  ["--pink", (c, x, y, side) => { c.beginPath(); c.moveTo(x, y); c.lineTo(x + side, y + side); c.stroke(); }],
];

/// The cells of the Δ that a person looks at: [column, row, before, after].
export function draw_delta(context, view, { delta, is_before }) {
  if (!delta || is_before || !view.frame) return;
  const { resolution_m: m, origin_m: [x, y] } = view.frame, side = Math.max(LEAST_CELL_PX, m * view.scale);
  context.lineWidth = 1.5;
  for (const [column, row, , after] of delta) {
    const [px, py] = view.to_screen(x + column * m, y + (row + 1) * m);
    const [ink, draw] = DELTA_SIGNS[after];
    context.fillStyle = context.strokeStyle = ink_of(ink);
    draw(context, px, py, side);
  }
}

/// The signs of a Δ's cells, as keys.
export function fill_delta_legend(host) {
  host.replaceChildren(...[[1, "became occupied"], [0, "became free"], [2, "forgotten"]].map(([state, text]) => {
    const key = document.createElement("span");
    key.className = "key";
    const [ink, draw] = DELTA_SIGNS[state];
    key.append(sign_of((c) => { c.fillStyle = c.strokeStyle = ink_of(ink); c.lineWidth = 1.5; draw(c, 6, 2, 10); }), text);
    explain(key, text);
    return key;
  }));
}

/// Where a person is about to say that the robot is. No layer: it cannot be switched off.
export function draw_wish(context, view, { wish }) {
  if (!wish) return;
  draw_ends(context, view, wish.ends, wish.words);
  const [x, y] = view.to_screen(wish.x, wish.y);
  const length = 60, [cos, sin] = [Math.cos(wish.heading), Math.sin(wish.heading)];
  context.strokeStyle = ink_of("--accent");
  context.lineWidth = 3;
  context.beginPath();
  context.moveTo(x, y);
  context.lineTo(x + length * cos, y - length * sin);
  context.lineTo(x + (length - 10) * cos + 6 * sin, y - (length - 10) * sin + 6 * cos);
  context.moveTo(x + length * cos, y - length * sin);
  context.lineTo(x + (length - 10) * cos - 6 * sin, y - (length - 10) * sin - 6 * cos);
  context.stroke();
  robot_sign(context, x, y, wish.heading, Math.max(LEAST_ROBOT_PX, ROBOT_M * view.scale), ink_of("--accent"));
}

function sign_thing(context, ink, dashes) {
  context.strokeStyle = ink_of(ink);
  context.setLineDash(dashes);
  context.lineWidth = 1.5;
  context.strokeRect(3, 2, 16, 10);
}

/// Side by side: what nobody has seen of one that stands there is dashed, what is assumed to be solid is filled.
function outline_thing(context, view, outline, ink, is_picked, dashes_of, is_assumed = false) {
  const corners = outline.polygon_m.map(([x, y]) => view.to_screen(x, y));
  context.fillStyle = ink_of(ink);
  context.globalAlpha = is_assumed ? 0.12 : 0;
  context.fill(new Path2D(`M${corners.map((corner) => corner.join(" ")).join("L")}Z`));
  context.globalAlpha = 1;
  context.strokeStyle = ink_of(ink);
  context.lineWidth = is_picked ? 3.5 : 1.5;
  corners.forEach(([x, y], side) => {
    context.setLineDash(dashes_of(side));
    context.beginPath();
    context.moveTo(x, y);
    context.lineTo(...corners[(side + 1) % 4]);
    context.stroke();
  });
  context.setLineDash([]);
}

const NOT_SEEN = [2, 3], ASSUMED = [7, 4];

function draw_things(context, view, { things, picked_thing }) {
  for (const thing of things ?? []) {
    const is_picked = thing === picked_thing;
    if (thing.from && (is_picked || !thing.at)) outline_thing(context, view, thing.from, "--blue", is_picked, () => [6, 2]);
    if (!thing.at) continue;
    const { sides_seen, sides_assumed = [] } = thing.at;
    outline_thing(context, view, thing.at, "--red", is_picked, (side) => (sides_seen[side] ? [] : sides_assumed[side] ? ASSUMED : NOT_SEEN),
                  sides_assumed.includes(true));
    const [x, y] = view.to_screen(thing.at.x_m, thing.at.y_m);
    context.fillStyle = ink_of("--text");
    context.textAlign = "center";
    context.fillText(thing.thing, x, y + 4);
    context.textAlign = "start";
  }
}

// From below to above.
export const LAYERS = [
  { id: "path", label: "path", draw: draw_path, sign: (c) => { c.strokeStyle = ink_of("--sky"); c.lineWidth = 2; c.beginPath(); c.moveTo(1, 12); c.lineTo(9, 4); c.lineTo(21, 7); c.stroke(); } },
  { id: "transient", label: "not (yet) map", is_of_now: true, draw: draw_transient,
    keys: [["stands there now", (c) => hatched(c, 5, 1, 12, 12, ink_of("--orange"))],
           ["seen gone", (c) => { c.strokeStyle = ink_of("--blue"); c.lineWidth = 1.5; c.strokeRect(5, 1, 12, 12); }]] },
  { id: "changes", label: "newest changes", draw: draw_changes, sign: (c) => { c.strokeStyle = ink_of("--red"); c.setLineDash([4, 3]); c.lineWidth = 1.5; circle(c, 11, 7, 6); c.stroke(); } },
  { id: "zones", label: "zones", is_of_now: true, draw: draw_zones,
    keys: Object.values(ZONES).map((zone) => [zone[0], (c) => sign_zone(c, zone)]) },
  { id: "bays", label: "bays", is_of_now: true, draw: draw_bays,
    keys: ["full", "partly", "empty", "unknown"].map((state) => [`bay ${state}`, (c) => sign_bay(c, state)]) },
  { id: "things", label: "things", is_of_now: true, draw: draw_things,
    keys: [["stands there, seen sides", (c) => sign_thing(c, "--red", [])], ["stands there, sides that nobody has seen", (c) => sign_thing(c, "--red", NOT_SEEN)],
           ["not seen, but assumed: the seen sides fix its rectangle", (c) => sign_thing(c, "--red", ASSUMED)],
           ["stood there and has gone", (c) => sign_thing(c, "--blue", [6, 2])]] },
  { id: "stored", label: "scans kept for the map", is_of_now: true, draw: draw_stored,
    keys: [["of the running Δ-phase", (c) => sign_stored(c, false)], ["of a set that waits", (c) => sign_stored(c, true)]] },
  { id: "scan", label: "scan: what its beams say", is_of_now: true, draw: draw_scan,
    keys: [["fits the map", FITS], ["short: something new stands there", SHORT], ["through what the map has: gone", THROUGH], ["where the map is unknown", NOT_KNOWN]]
      .map(([text, word]) => [text, (c) => sign_beam(c, word)]) },
  { id: "hypothesis", label: "other hypothesis", is_of_now: true, is_gone_when_old: true, draw: draw_hypothesis, sign: (c) => robot_sign(c, 11, 7, 0, 6, ink_of("--pink")) },
  { id: "particles", label: "particles, a few for all", is_of_now: true, is_gone_when_old: true, draw: draw_particles, sign: sign_particles },
  { id: "way", label: "where the pilot drives", is_of_now: true, is_gone_when_old: true, draw: draw_way, sign: sign_way },
  { id: "robot", label: `robot, ${SIGMAS} σ`, is_of_now: true, draw: draw_robot, sign: (c) => robot_sign(c, 11, 7, 0, 6, ink_of("--blue")) },
];

function sign_of(draw) {
  const canvas = document.createElement("canvas");
  const dots = 2;
  canvas.width = 22 * dots;
  canvas.height = 14 * dots;
  canvas.setAttribute("aria-hidden", "true");
  const context = canvas.getContext("2d");
  context.scale(dots, dots);
  draw(context);
  return canvas;
}

/// Check boxes that are the legend too. `shown` holds the ids of the layers that are on.
export function fill_legend(host, shown, on_change) {
  host.replaceChildren();
  for (const layer of [...LAYERS].reverse()) {
    const label = document.createElement("label");
    const box = document.createElement("input");
    box.type = "checkbox";
    box.id = `layer-${layer.id}`;
    box.checked = shown.has(layer.id);
    box.addEventListener("change", () => {
      if (box.checked) shown.add(layer.id); else shown.delete(layer.id);
      on_change();
    });
    label.append(box, ...(layer.sign ? [sign_of(layer.sign)] : []), layer.label);
    explain(label, layer.label);
    host.append(label);
    for (const [text, draw] of layer.keys ?? []) {
      const key = document.createElement("div");
      key.className = "key";
      key.append(sign_of(draw), text);
      explain(key, text);
      host.append(key);
    }
  }
}

export function draw_scale_bar(context, view) {
  const most_px = Math.min(160, view.width / 3);
  const power = 10 ** Math.floor(Math.log10(most_px / view.scale));
  const length_m = [5, 2, 1].map((n) => n * power).find((m) => m * view.scale <= most_px);
  const length_px = length_m * view.scale, x = 14, y = Math.min(view.height, view.free_room().last) - 14;
  const text = length_m >= 1 ? `${length_m} m` : `${Math.round(100 * length_m)} cm`;
  context.font = "12px system-ui, sans-serif";
  context.fillStyle = ink_of("--card");
  context.globalAlpha = 0.85;
  context.fillRect(x - 6, y - 20, Math.max(length_px, context.measureText(text).width) + 12, 27);
  context.globalAlpha = 1;
  context.strokeStyle = context.fillStyle = ink_of("--text");
  context.lineWidth = 2;
  context.beginPath();
  context.moveTo(x, y - 5);
  context.lineTo(x, y);
  context.lineTo(x + length_px, y);
  context.lineTo(x + length_px, y - 5);
  context.stroke();
  context.fillText(text, x + 2, y - 8);
}
