// SPDX-License-Identifier: Apache-2.0
// What the pose rests on, what the map will be drawn from, and what the pilot wants: layers over the map.

import { circle, ink_of } from "./canvas.js";

const WAY_S = 2;         // of the pilot's way that are drawn
const STANDS_M = 0.02;   // a way shorter than that is a turn on the spot
const TURN_M = 0.55;     // radius of the arrow that stands for one
const STEPS = 24;

/// Each particle is a short line from its place to where it looks.
export function draw_particles(context, view, { particles }) {
  const length = Math.max(5, 0.12 * view.scale);
  context.strokeStyle = ink_of("--violet");
  context.lineWidth = 1.25;
  context.globalAlpha = 0.6;
  context.beginPath();
  for (let i = 0; i < particles.length; i += 3) {
    const [x, y] = view.to_screen(particles[i], particles[i + 1]);
    context.moveTo(x, y);
    context.lineTo(x + length * Math.cos(particles[i + 2]), y - length * Math.sin(particles[i + 2]));
  }
  context.stroke();
  context.globalAlpha = 1;
}

export function sign_particles(context) {
  const view = { scale: 1, to_screen: (x, y) => [x, y] };
  draw_particles(context, view, { particles: [4, 9, 0.4, 8, 4, 0.1, 9, 11, 0.6, 13, 7, 0.2] });
}

// Filled of the running phase, hollow of a set that waits.
function kept_end(context, x, y, size, waits) {
  if (waits) context.strokeRect(x - size / 2, y - size / 2, size, size);
  else context.fillRect(x - size / 2, y - size / 2, size, size);
}

export function draw_stored(context, view, { stored }) {
  const size = Math.max(2.5, Math.min(6, 0.06 * view.scale));
  context.fillStyle = context.strokeStyle = ink_of("--violet");
  context.lineWidth = 1;
  for (const { x, y, waits, ends } of stored) {
    for (let i = 0; i < ends.length; i += 2) kept_end(context, ...view.to_screen(ends[i], ends[i + 1]), size, waits);
    circle(context, ...view.to_screen(x, y), 4);
    context.stroke();
  }
}

export function sign_stored(context, waits) {
  context.fillStyle = context.strokeStyle = ink_of("--violet");
  context.lineWidth = 1;
  for (const [x, y] of [[5, 9], [11, 6], [17, 8]]) kept_end(context, x, y, 4, waits);
}

/// The places that a robot passes which keeps its speed (m/s) and its turn rate (rad/s).
export function way_of({ x_m, y_m, heading_rad }, { speed_m_per_s: speed, turn_rate_rad_per_s: rate }) {
  const places = [];
  const is_turn = Math.abs(speed) * WAY_S < STANDS_M;
  for (let i = 0; i <= STEPS; ++i) {
    const turned = heading_rad + rate * WAY_S * i / STEPS;
    if (is_turn) places.push([x_m + TURN_M * Math.cos(turned), y_m + TURN_M * Math.sin(turned)]);
    else {
      const chord = speed * WAY_S * i / STEPS, bend = rate * WAY_S * i / STEPS / 2;
      const length = Math.abs(bend) > 1e-6 ? chord * Math.sin(bend) / bend : chord;
      places.push([x_m + length * Math.cos(heading_rad + bend), y_m + length * Math.sin(heading_rad + bend)]);
    }
  }
  return places;
}

function arrow(context, points) {
  const [[ax, ay], [bx, by]] = points.slice(-2);
  const angle = Math.atan2(by - ay, bx - ax);
  context.lineWidth = 2.5;
  context.beginPath();
  for (const [x, y] of points) context.lineTo(x, y);
  for (const side of [-2.6, 2.6]) {
    context.moveTo(bx, by);
    context.lineTo(bx + 7 * Math.cos(angle + side), by + 7 * Math.sin(angle + side));
  }
  context.stroke();
}

export function draw_way(context, view, { pose }) {
  if (!pose?.pilot || (pose.pilot.speed_m_per_s === 0 && pose.pilot.turn_rate_rad_per_s === 0)) return;
  context.strokeStyle = ink_of("--accent");
  arrow(context, way_of(pose, pose.pilot).map(([x, y]) => view.to_screen(x, y)));
}

export function sign_way(context) {
  context.strokeStyle = ink_of("--accent");
  arrow(context, [[2, 11], [9, 8], [19, 5]]);
}
