// SPDX-License-Identifier: Apache-2.0
// What each beam of a scan says of the map: its way is walked over the cells, once for each scan.

import { FREE, OCCUPIED } from "./map_view.js";

export const FITS = 0, SHORT = 1, THROUGH = 2, NOT_KNOWN = 3;

const REACH_M = 0.15;   // a beam that ends so close to an occupied cell agrees with the map
const BEHIND_M = 0.3;   // so far behind an obstacle of the map a beam ends that has gone through it
const BESIDE_M = 0.1;   // so far to both sides the obstacle must be met as well: no edge that is grazed

/// Whether an occupied cell lies on the way from one point to another (in cells, not whole).
function meets_occupied(state_of, x0, y0, x1, y1) {
  let column = Math.floor(x0), row = Math.floor(y0);
  const dx = x1 - x0, dy = y1 - y0, across = Math.sign(dx), up = Math.sign(dy);
  let to_column = dx ? (column + (dx > 0) - x0) / dx : Infinity;  // shares of the way to the next border
  let to_row = dy ? (row + (dy > 0) - y0) / dy : Infinity;
  for (;;) {
    if (state_of(column, row) === OCCUPIED) return true;
    if (to_column > 1 && to_row > 1) return false;
    if (to_column < to_row) {
      column += across;
      to_column += across / dx;
    } else {
      row += up;
      to_row += up / dy;
    }
  }
}

function goes_through(view, state_of, place, end_x, end_y) {
  const cell_m = view.frame.resolution_m, [left, bottom] = view.frame.origin_m;
  const length = Math.hypot(end_x - place.x, end_y - place.y);
  if (length <= BEHIND_M) return false;
  const ux = (end_x - place.x) / length, uy = (end_y - place.y) / length, reach = length - BEHIND_M;
  return [0, -BESIDE_M, BESIDE_M].every((beside) => {
    const x = place.x - beside * uy - left, y = place.y + beside * ux - bottom;
    return meets_occupied(state_of, x / cell_m, y / cell_m, (x + reach * ux) / cell_m, (y + reach * uy) / cell_m);
  });
}

/// For each end (m, in the map: x, y, x, y, …) of the beams of a robot at `place`: FITS an obstacle of the map, SHORT of
/// what the map has (it is free there), THROUGH an obstacle of the map, or NOT_KNOWN there.
export function beam_words(view, place, ends) {
  const words = new Uint8Array(ends.length / 2).fill(NOT_KNOWN);
  if (!view.frame) return words;
  const state_of = view.states();
  for (let i = 0; i < words.length; ++i) {
    const x = ends[2 * i], y = ends[2 * i + 1];
    if (goes_through(view, state_of, place, x, y)) words[i] = THROUGH;
    else {
      const state = view.state_near(x, y, REACH_M, state_of);
      if (state === OCCUPIED) words[i] = FITS;
      else if (state === FREE) words[i] = SHORT;
    }
  }
  return words;
}

/// Share of the beams that fit; null where there is none.
export function share_that_fits(words) {
  return words.length ? words.filter((word) => word === FITS).length / words.length : null;
}
