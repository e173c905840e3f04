// SPDX-License-Identifier: Apache-2.0
// The incidents that the daemon has kept, newest first, each with a link to its page in words.

import { fetched } from "./history.js";
import { date_and_clock } from "./time_text.js";

const PERIOD_MS = 10000;
const MOST = 20;

const by_id = (id) => document.getElementById(id);

/// A small one that leads to the whole.
function picture_of(incident) {
  const link = document.createElement("a");
  link.href = `/api/incidents/${incident.name}/picture.png`;
  link.target = "_blank";
  link.rel = "noopener";
  const picture = document.createElement("img");
  picture.src = link.href;
  picture.loading = "lazy";
  picture.alt = `map, scan and pose at the moment of ${incident.kind}`;
  link.append(picture);
  return link;
}

function item_of(incident) {
  const item = document.createElement("li");
  const link = document.createElement("a");
  link.href = `/api/incidents/${incident.name}`;
  link.target = "_blank";
  link.rel = "noopener";
  link.textContent = incident.kind;
  const time = document.createElement("time");
  time.textContent = date_and_clock(Date.parse(incident.time) / 1000);
  const what = document.createElement("span");
  what.className = "what";
  what.textContent = incident.words;
  item.append(link, time, what);
  if (incident.picture) item.append(picture_of(incident));
  return item;
}

/// {folder, incidents}; an empty folder: none are kept.
export function show_incidents({ folder, incidents }) {
  by_id("incidents-box").hidden = by_id("mark").hidden = !folder;
  by_id("incidents-count").textContent = incidents.length ? `${incidents.length} kept` : "none yet";
  by_id("incidents").replaceChildren(...incidents.slice(-MOST).reverse().map(item_of));
}

/// Asks now and then while the page is looked at and `wants` says so.
export class Incidents {
  constructor(wants) {
    this.wants = wants;
    setInterval(() => this.look(), PERIOD_MS);
  }

  async look() {
    if (document.hidden || !this.wants()) return;
    try {
      show_incidents(await (await fetched("/api/incidents")).json());
    } catch { /* the page tells already that the daemon cannot be reached */ }
  }
}
