// SPDX-License-Identifier: Apache-2.0
// What everything drawn on a canvas needs.

/// A colour of the style sheet: "--blue" is "#0072b2".
export const ink_of = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();

/// Dots of the screen for each pixel of the page; more than two are not seen.
export const dots_per_px = () => Math.min(2, devicePixelRatio || 1);

/// A function that has `draw` called before the next frame is shown, once however often it was called.
export function once_a_frame(draw) {
  let is_due = false;
  return () => {
    if (is_due) return;
    is_due = true;
    requestAnimationFrame(() => {
      is_due = false;
      draw();
    });
  };
}

export function circle(context, x, y, radius) {
  context.beginPath();
  context.arc(x, y, radius, 0, 2 * Math.PI);
}
