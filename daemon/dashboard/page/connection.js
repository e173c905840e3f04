// SPDX-License-Identifier: Apache-2.0
// The live stream (docs/api.md): keeps a WebSocket open, decodes what comes, and tries again when it ends.

import { placed_ends } from "./layers.js";

const CELLS = 1, SAMPLES = 2, SCAN = 3, PARTICLES = 4, STORED = 5;
const FIRST_PAUSE_MS = 500, LONGEST_PAUSE_MS = 5000;
const SILENCE_MS = 4000; // a status comes every second

/// A box of cells (kind 1).
export function cells_of(view) {
  const [column, row, width, height] = [8, 12, 16, 20].map((at) => view.getInt32(at, true));
  const states = new Uint8Array(width * height);
  let next = 0;
  for (let at = 24; at + 1 < view.byteLength; at += 2) {
    const run = view.getUint16(at, true);
    states.fill(run >> 14, next, next + (run & 0x3fff));
    next += run & 0x3fff;
  }
  return { revision: view.getUint32(4, true), column, row, width, height, states };
}

function samples_of(view, columns) {
  const count = view.getUint32(4, true), began = view.getFloat64(8, true);
  const rows = [];
  for (let i = 0, at = 16; i < count; ++i) {
    const row = { time: began + view.getFloat32(at, true) };
    at += 4;
    for (const name of columns) {
      row[name] = view.getFloat32(at, true);
      at += 4;
    }
    rows.push(row);
  }
  return rows;
}

function scan_of(view) {
  const count = view.getUint32(4, true);
  const [x, y, heading] = [16, 20, 24].map((at) => view.getFloat32(at, true));
  const beams = new Int16Array(2 * count);
  for (let i = 0; i < 2 * count; ++i) beams[i] = view.getInt16(28 + 2 * i, true);
  const scan = { time: view.getFloat64(8, true), x, y, heading, beams };
  return { ...scan, ends: placed_ends(scan, scan) };
}

/// Places and headings, one after another: x, y, heading.
function particles_of(view) {
  const count = view.getUint32(4, true), [x, y, step] = [8, 12, 16].map((at) => view.getFloat32(at, true));
  const poses = new Float32Array(3 * count);
  for (let i = 0; i < 3 * count; i += 3) {
    const [dx, dy, turn] = [20, 22, 24].map((at) => view.getInt16(at + 2 * i, true));
    poses.set([x + dx * step, y + dy * step, turn / 32767 * Math.PI], i);
  }
  return poses;
}

function stored_of(view) {
  const scans = [];
  for (let i = 0, at = 8; i < view.getUint32(4, true); ++i) {
    const [x, y, heading] = [4, 8, 12].map((from) => view.getFloat32(at + from, true));
    const beams = new Int16Array(2 * view.getUint32(at + 16, true));
    for (let n = 0; n < beams.length; ++n) beams[n] = view.getInt16(at + 20 + 2 * n, true);
    const place = { x, y, heading };
    scans.push({ ...place, waits: view.getUint32(at, true) === 1, ends: placed_ends({ beams }, place) });
    at += 20 + 2 * beams.length;
  }
  return scans;
}

/// `on` holds a function for each kind of message (hello, map, cells, pose, scan, particles, stored, transient, status, samples, changes)
/// and link("connecting" | "live" | "lost").
export class Connection {
  constructor(on) {
    this.on = on;
    this.pause_ms = FIRST_PAUSE_MS;
    this.columns = [];
    this.last = 0;
    setInterval(() => this.look(), 1000);
    this.open();
  }

  open() {
    this.on.link("connecting");
    const socket = new WebSocket(`ws://${location.host}/live`);
    socket.binaryType = "arraybuffer";
    socket.onmessage = (event) => this.take(event.data);
    socket.onclose = () => this.lose();
    this.socket = socket;
    this.last = Date.now();
  }

  lose() {
    this.socket = null;
    this.on.link("lost");
    setTimeout(() => this.open(), this.pause_ms);
    this.pause_ms = Math.min(2 * this.pause_ms, LONGEST_PAUSE_MS);
  }

  /// A link that is silent has died, whatever the browser thinks: its close would wait for the other side.
  look() {
    const silent = this.socket;
    if (!silent || document.hidden || Date.now() - this.last <= SILENCE_MS) return;
    silent.onmessage = silent.onclose = null;
    silent.close();
    this.lose();
  }

  take(data) {
    this.last = Date.now();
    if (typeof data === "string") {
      const message = JSON.parse(data);
      if (message.type === "hello") {
        this.columns = message.sample_columns;
        this.pause_ms = FIRST_PAUSE_MS;
        this.on.link("live");
      }
      this.on[message.type]?.(message);
      return;
    }
    const view = new DataView(data);
    const kind = view.getUint32(0, true);
    if (kind === CELLS) this.on.cells(cells_of(view));
    if (kind === SAMPLES) this.on.samples(samples_of(view, this.columns));
    if (kind === SCAN) this.on.scan(scan_of(view));
    if (kind === PARTICLES) this.on.particles(particles_of(view));
    if (kind === STORED) this.on.stored(stored_of(view));
  }
}
