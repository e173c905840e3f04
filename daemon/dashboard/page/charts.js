// SPDX-License-Identifier: Apache-2.0
// Lines over time on small canvases. All charts share the time axis and the instant under the pointer; the value axis
// fits what is shown.

import { dots_per_px, ink_of, once_a_frame } from "./canvas.js";
import { explain } from "./glossary.js";
import { clock } from "./time_text.js";

const LEFT = 46, RIGHT = 6, TOP = 6, BOTTOM = 16; // px around the plot
const GAP_S = 5;  // a line is not joined over a longer silence
const SPANS = [["1 min", 60], ["10 min", 600], ["1 h", 3600]];
const MOST_POINTS = 3000; // of a line; of more, every second, third, … is drawn
const DASHES = { solid: [], dashed: [5, 3], dotted: [2, 2] };

const line = (column, label, ink, dash = "solid") => ({ column, label, ink, dash });
// `is_explained_whole`: its lines have no lines of the glossary of their own. `method`: the one that decides by it; of the other it tells nothing.
const CHARTS = [
  { title: "Belief", lines: [line("pose_right", "P(pose right)", "--blue"), line("map_wrong", "P(map wrong)", "--red", "dashed")], threshold: "pose_right", beyond: "written from" },
  { title: "Weight", method: "paper", lines: [line("w_avg", "w_avg", "--sky"), line("w_fast", "w_fast", "--red", "dashed"), line("w_slow", "w_slow", "--text", "dotted")] },
  { title: "Divergence ratio", method: "paper", lines: [line("r_d", "r_d", "--blue")], threshold: "r_d", beyond: "stored above" },
  { title: "Effective samples", method: "paper", lines: [line("n_eff", "N_eff", "--green")] },
  { title: "Scans a second", is_explained_whole: true, lines: [line("scans_per_s", "1/s", "--blue")] },
  { title: "Latency", is_explained_whole: true, lines: [line("latency_ms", "ms", "--pink")] },
  { title: "Processor, % of one", is_explained_whole: true, lines: [line("cpu_localization", "pose", "--blue"), line("cpu_delta", "Δ", "--red", "dashed"), line("cpu_map", "map", "--green"),
    line("cpu_io", "ports", "--text", "dotted"), line("cpu_recorder", "disk", "--pink", "dashed"), line("cpu_page", "page", "--orange", "dotted")] },
  { title: "Memory", is_explained_whole: true, lines: [line("memory_mib", "MiB", "--blue")] },
  { title: "Wheels go beyond their count, %", lines: [line("wheel_distance", "distance", "--blue"), line("wheel_turn", "turn", "--red", "dashed")] },
];

/// A step of 1, 2 or 5 times a power of ten that divides `span` into at most `most` parts.
export function step_for(span, most) {
  const power = 10 ** Math.floor(Math.log10(span / most));
  return [1, 2, 5, 10].map((n) => n * power).find((step) => span / step <= most + 1e-9);
}

const NEAR_ZERO = 0.3; // of the largest: an axis from 0 wastes little
const LEAST_SPAN = 0.02; // of the value

/// The axis of values from `low` to `high`, with round ends, by the rule of the reports (axis_for in experiments/report/svg_chart.cpp); besides,
/// noise fills no chart.
export function axis_for(low, high, most = 4) {
  if (low >= 0 && low <= NEAR_ZERO * high) low = 0;
  if (high <= 0 && high >= NEAR_ZERO * low) high = 0;
  if (!(high > low)) {
    const around = low === 0 ? 0.5 : 0.1 * Math.abs(low);
    [low, high] = [low - around, high + around];
  }
  const wanting = LEAST_SPAN * Math.max(Math.abs(low), Math.abs(high)) - (high - low);
  if (wanting > 0) [low, high] = [low - wanting / 2, high + wanting / 2];
  const step = step_for(high - low, most);
  return { low: Math.floor(low / step + 1e-9) * step, high: Math.ceil(high / step - 1e-9) * step, step };
}

export const short = (value) => {
  if (!Number.isFinite(value)) return "–";
  const size = Math.abs(value);
  return size >= 100 ? value.toFixed(0) : size >= 10 ? value.toFixed(1) : size >= 0.095 || size === 0 ? value.toFixed(2) : value.toFixed(3);
};

const tick_text = (value, step) => value.toFixed(Math.max(0, Math.min(6, -Math.floor(Math.log10(step) + 1e-9))));

class Chart {
  constructor(host, kind, on_hover, on_pick) {
    this.kind = kind;
    const figure = document.createElement("figure");
    this.caption = document.createElement("figcaption");
    this.canvas = document.createElement("canvas");
    this.canvas.tabIndex = 0;
    this.canvas.setAttribute("role", "img");
    figure.append(this.caption, this.canvas);
    host.append(figure);
    const title = document.createElement("b");
    title.textContent = kind.title;
    explain(title);
    this.values = kind.lines.map(({ label, ink, dash }) => {
      const value = document.createElement("span");
      explain(value, kind.is_explained_whole ? kind.title : label);
      value.style.setProperty("--ink", `var(${ink})`);
      value.style.setProperty("--dash", dash);
      return value;
    });
    this.caption.append(title, ...this.values);
    this.canvas.addEventListener("pointermove", (event) => on_hover(this.time_at(event.offsetX)));
    this.canvas.addEventListener("click", (event) => on_pick(this.time_at(event.offsetX)));
    this.canvas.addEventListener("pointerleave", () => on_hover(null));
    this.canvas.addEventListener("blur", () => on_hover(null));
    this.canvas.addEventListener("keydown", (event) => {
      if (event.key === "ArrowLeft") on_hover("earlier");
      else if (event.key === "ArrowRight") on_hover("later");
      else if (event.key === "Escape") on_hover(null);
      else return;
      event.preventDefault();
    });
  }

  set_shown(is_shown) { this.canvas.parentElement.hidden = !is_shown; }

  time_at(px) {
    const share = (px - LEFT) / Math.max(1, this.canvas.clientWidth - LEFT - RIGHT);
    return this.from + Math.min(1, Math.max(0, share)) * (this.to - this.from);
  }

  value_axis(samples, threshold) {
    let low = Infinity, high = -Infinity;
    for (const sample of samples) {
      for (const { column } of this.kind.lines) {
        if (!Number.isFinite(sample[column])) continue;
        low = Math.min(low, sample[column]);
        high = Math.max(high, sample[column]);
      }
    }
    if (threshold != null) [low, high] = [Math.min(low, threshold), Math.max(high, threshold)];
    return low > high ? axis_for(0, 1) : axis_for(low, high);
  }

  draw(samples, from, to, threshold, instant, every) {
    [this.from, this.to] = [from, to];
    const dots = dots_per_px();
    const width = this.canvas.clientWidth, height = this.canvas.clientHeight;
    if (!width) return;
    this.canvas.width = Math.round(width * dots);
    this.canvas.height = Math.round(height * dots);
    const context = this.canvas.getContext("2d");
    context.scale(dots, dots);
    const axis = this.value_axis(samples, threshold);
    const x_of = (time) => LEFT + (time - from) / (to - from) * (width - LEFT - RIGHT);
    const y_of = (value) => TOP + (axis.high - value) / (axis.high - axis.low) * (height - TOP - BOTTOM);
    this.draw_axes(context, axis, x_of, y_of, width, height);
    if (threshold != null) this.draw_threshold(context, y_of(threshold), width, `${this.kind.beyond} ${short(threshold)}`);
    for (const kind of this.kind.lines) this.draw_line(context, samples, kind, x_of, y_of, every);
    if (instant) this.draw_instant(context, x_of(instant.time), height);
    this.tell(instant ?? samples.at(-1), threshold);
  }

  draw_axes(context, axis, x_of, y_of, width, height) {
    context.font = "11px system-ui, sans-serif";
    context.fillStyle = ink_of("--soft");
    context.strokeStyle = ink_of("--line");
    context.lineWidth = 1;
    context.textAlign = "right";
    context.textBaseline = "middle";
    for (let i = 0, value = axis.low; value <= axis.high + axis.step / 2; value = axis.low + ++i * axis.step) {
      const y = Math.round(y_of(value)) + 0.5;
      context.beginPath();
      context.moveTo(LEFT, y);
      context.lineTo(width - RIGHT, y);
      context.stroke();
      context.fillText(tick_text(value, axis.step), LEFT - 5, y);
    }
    context.textBaseline = "alphabetic";
    context.textAlign = "left";
    context.fillText(clock(this.from), LEFT, height - 3);
    context.textAlign = "right";
    context.fillText(clock(this.to), width - RIGHT, height - 3);
  }

  /// What it decides stands below the line, or above it where there is no room.
  draw_threshold(context, y, width, words) {
    context.strokeStyle = ink_of("--soft");
    context.setLineDash([1, 3]);
    context.lineWidth = 1.5;
    context.beginPath();
    context.moveTo(LEFT, y);
    context.lineTo(width - RIGHT, y);
    context.stroke();
    context.setLineDash([]);
    context.fillStyle = ink_of("--soft");
    context.textAlign = "left";
    context.fillText(words, LEFT + 4, y + 14 < this.canvas.clientHeight - BOTTOM ? y + 12 : y - 5);
  }

  draw_line(context, samples, { column, ink, dash }, x_of, y_of, every) {
    context.strokeStyle = ink_of(ink);
    context.setLineDash(DASHES[dash]);
    context.lineWidth = 1.5;
    context.beginPath();
    let last = -Infinity;
    for (const sample of samples) {
      const x = x_of(sample.time), y = y_of(sample[column]);
      if (sample.time - last > GAP_S * every || !Number.isFinite(y)) context.moveTo(x, y); else context.lineTo(x, y);
      last = sample.time;
    }
    context.stroke();
    context.setLineDash([]);
  }

  draw_instant(context, x, height) {
    context.strokeStyle = ink_of("--text");
    context.lineWidth = 1;
    context.beginPath();
    context.moveTo(Math.round(x) + 0.5, TOP);
    context.lineTo(Math.round(x) + 0.5, height - BOTTOM);
    context.stroke();
  }

  tell(sample, threshold) {
    this.kind.lines.forEach(({ column, label }, i) => {
      this.values[i].textContent = `${label} ${sample ? short(sample[column]) : "–"}`;
    });
    const told = this.values.map((value) => value.textContent).join(", ");
    this.canvas.setAttribute("aria-label", `${this.kind.title}: ${told}` + (threshold != null ? `, threshold ${short(threshold)}` : ""));
  }
}

export class Charts {
  constructor(host, spans_host, instant_host) {
    this.instant_host = instant_host;
    this.draw_soon = once_a_frame(() => this.draw());
    this.samples = [];
    this.thresholds = {};
    this.method = null; // of mapping
    this.span_s = SPANS[1][1];
    this.instant = null; // the sample under the pointer
    this.until = null;   // the time that a person looks at; null: now
    this.on_pick = () => {};
    this.charts = CHARTS.map((kind) => new Chart(host, kind, (at) => this.hover(at), (time) => this.on_pick(time)));
    this.spans_host = spans_host;
    this.add_spans(SPANS);
    new ResizeObserver(() => this.draw_soon()).observe(host);
  }

  /// Of a run that is over: the whole of it, too.
  set_whole(is_whole) {
    this.until = null;
    const spans = is_whole ? [...SPANS, ["all", Infinity]] : SPANS;
    if (this.spans_host.children.length === spans.length) return;
    this.span_s = is_whole ? Infinity : SPANS[1][1];
    this.spans_host.replaceChildren();
    this.add_spans(spans);
  }

  add_spans(spans) {
    const host = this.spans_host;
    for (const [label, span_s] of spans) {
      const button = document.createElement("button");
      button.type = "button";
      button.textContent = label;
      explain(button, "length of the charts");
      button.setAttribute("aria-pressed", String(span_s === this.span_s));
      button.addEventListener("click", () => {
        this.span_s = span_s;
        for (const other of host.children) other.setAttribute("aria-pressed", String(other === button));
        this.draw_soon();
      });
      host.append(button);
    }
  }

  hover(at) {
    const samples = this.samples;
    if (at === null || !samples.length) this.instant = null;
    else if (typeof at === "number") {
      this.instant = samples.reduce((best, one) => (Math.abs(one.time - at) < Math.abs(best.time - at) ? one : best));
    } else {
      const now = this.instant ? samples.indexOf(this.instant) : samples.length - 1;
      this.instant = samples[Math.min(samples.length - 1, Math.max(0, now + (at === "later" ? 1 : -1)))];
    }
    this.draw_soon();
  }

  draw() {
    const last = this.samples.at(-1)?.time ?? Date.now() / 1000, first = this.samples[0]?.time ?? last;
    const to = this.until === null ? last : Math.min(last, Math.max(this.until + this.span_s / 2, first + this.span_s));
    // A young run fills the axis: from its beginning, a minute at least.
    const from = Math.max(to - this.span_s, Math.min(first, to - SPANS[0][1]));
    const inside = this.samples.filter((sample) => sample.time >= from && sample.time <= to);
    const every = Math.ceil(inside.length / MOST_POINTS), shown = inside.filter((_, i) => i % every === 0);
    for (const chart of this.charts) {
      chart.set_shown((!chart.kind.method || chart.kind.method === this.method) && this.samples.some((sample) => chart.kind.lines.some(({ column }) => Number.isFinite(sample[column]))));
    }
    const instant = this.instant ?? (this.until === null ? null : inside.findLast((sample) => sample.time <= this.until) ?? inside[0]);
    for (const chart of this.charts) {
      chart.draw(shown, from, to, this.thresholds[chart.kind.threshold] ?? null, instant ?? null, every);
    }
    this.instant_host.textContent = this.instant ? `at ${clock(this.instant.time)}` : "";
  }
}
