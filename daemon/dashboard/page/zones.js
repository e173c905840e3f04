// SPDX-License-Identifier: Apache-2.0
// Zones of the site, outlined on the map. Asked for every ten seconds; a run that is over has none.

import { NAMED_FROM, trace_polygon } from "./bays.js";
import { ink_of } from "./canvas.js";

const ASK_EVERY_MS = 10000;
export const ZONES = { FROZEN: ["zone frozen", "--blue", []], TEMPORARY: ["zone temporary", "--orange", [8, 4]], IGNORE: ["zone ignored", "--soft", [2, 4]],
                       BLOCKED: ["zone blocked", "--stop", []], SPEED_LIMIT: ["zone slow", "--violet", [8, 4]] };

export class ZoneWatch {
  constructor(model, on_news) {
    this.model = model;
    this.on_news = on_news;
    model.zones = [];
    setInterval(() => this.ask(), ASK_EVERY_MS);
  }

  clear() {
    this.model.zones = [];
    setTimeout(() => this.ask(), 1000);
  }

  async ask() {
    if (this.model.run || document.hidden) return;
    try {
      const answer = await fetch("/api/zones", { signal: AbortSignal.timeout(ASK_EVERY_MS) });
      if (!answer.ok) return;
      this.model.zones = (await answer.json()).zones;
      this.on_news();
    } catch { /* asked again in a moment */ }
  }
}

/// Right of the highest corner, where no bay has its name.
function write_name(context, view, { zoneId, vertices }, ink) {
  const highest = vertices.reduce((one, other) => (other.y > one.y || (other.y === one.y && other.x < one.x) ? other : one));
  const [x, y] = view.to_screen(highest.x, highest.y);
  context.fillStyle = ink_of(ink);
  context.fillText(zoneId, x + 5, y + 14);
}

export function draw_zones(context, view, { zones }) {
  for (const zone of zones ?? []) {
    const [, ink, dashes] = ZONES[zone.zoneType];
    trace_polygon(context, view, zone.vertices.map(({ x, y }) => [x, y]));
    context.strokeStyle = ink_of(ink);
    context.lineWidth = 2;
    context.setLineDash(dashes);
    context.stroke();
    context.setLineDash([]);
    if (view.scale >= NAMED_FROM) write_name(context, view, zone, ink);
  }
}

export function sign_zone(context, [, ink, dashes]) {
  context.strokeStyle = ink_of(ink);
  context.lineWidth = 2;
  context.setLineDash(dashes);
  context.strokeRect(3, 2, 16, 10);
}
