// SPDX-License-Identifier: Apache-2.0
// Dark and light, and the values of all lines of a chart under the pointer or the arrow keys.
"use strict";

const root = document.documentElement, system_dark = matchMedia("(prefers-color-scheme: dark)");
let chosen = null; // by a person, for this page
function apply_theme() { root.dataset.theme = chosen ?? (system_dark.matches ? "dark" : "light"); }
system_dark.addEventListener("change", apply_theme);
apply_theme();

/// Three digits, as the tables have them.
function short(value) {
  if (!Number.isFinite(value)) return "–";
  if (Math.abs(value) >= 100) return value.toFixed(0);
  return String(Number(value.toPrecision(3)));
}

function take_chart(figure) {
  const svg = figure.querySelector("svg"), line = svg.querySelector(".instant");
  const numbers = (name) => svg.dataset[name].split(" ").map(Number);
  const [left, top, right, bottom] = numbers("plot"), [x_low, x_high] = numbers("x"), [y_low, y_high] = numbers("y");
  const series = [...svg.querySelectorAll("polyline")].map(({ points }) => [...points]);
  const outputs = figure.querySelectorAll(".keys output"), where = figure.querySelector("figcaption output");
  const places = [...new Set(series.flat().map(({ x }) => x))].sort((a, b) => a - b);
  const value_at = (low, high, share) => low + share * (high - low);
  const nearest = (points, px) => points.reduce((best, one) => (Math.abs(one.x - px) < Math.abs(best.x - px) ? one : best), points[0]);
  let at = null;

  function show(px) {
    at = px;
    line.style.visibility = px === null ? "" : "visible";
    where.textContent = px === null ? "" : ` at ${short(value_at(x_low, x_high, (px - left) / (right - left)))}`;
    if (px !== null) { line.setAttribute("x1", px); line.setAttribute("x2", px); }
    series.forEach((points, i) => {
      const point = px === null || !points.length ? null : nearest(points, px);
      outputs[i].textContent = point ? short(value_at(y_low, y_high, (bottom - point.y) / (bottom - top))) : "";
    });
  }
  svg.addEventListener("pointermove", (event) => {
    const box = svg.getBoundingClientRect();
    const px = (event.clientX - box.left) / box.width * svg.viewBox.baseVal.width;
    show(places.length ? places.reduce((best, one) => (Math.abs(one - px) < Math.abs(best - px) ? one : best)) : null);
  });
  svg.addEventListener("pointerleave", () => show(null));
  svg.addEventListener("blur", () => show(null));
  svg.addEventListener("keydown", (event) => {
    const step = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
    if (!step || !places.length) return;
    const next = at === null ? (step > 0 ? 0 : places.length - 1) : places.indexOf(at) + step;
    show(places[Math.max(0, Math.min(places.length - 1, next))]);
    event.preventDefault();
  });
}

addEventListener("DOMContentLoaded", () => {
  document.querySelector("#theme").addEventListener("click", () => {
    chosen = root.dataset.theme === "dark" ? "light" : "dark";
    apply_theme();
  });
  document.querySelectorAll("figure.chart").forEach(take_chart);
});
