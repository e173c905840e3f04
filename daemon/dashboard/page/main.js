// SPDX-License-Identifier: Apache-2.0
// Joins the live stream, the map, the charts and the panels.

import { Bays, middle_of } from "./bays.js";
import { add_changes, clear_changes, mark_picked } from "./changes.js";
import { Charts } from "./charts.js";
import { Connection } from "./connection.js";
import { Control } from "./control.js";
import { draw_drawing, Drawing } from "./drawing.js";
import { explain } from "./glossary.js";
import { History } from "./history.js";
import { Incidents } from "./incidents.js";
import { draw_delta, draw_scale_bar, draw_wish, fill_delta_legend, fill_legend, has_place, LAYERS } from "./layers.js";
import { MapView } from "./map_view.js";
import { show_link, show_pose, show_run, show_status } from "./panels.js";
import { Run } from "./run.js";
import { outline_of, Things } from "./things.js";
import { ZoneWatch } from "./zones.js";

const MOST_SAMPLES = 3600;
const NARROW_PX = 1400; // the legend would take a third of the map
const OLD_MS = 2000;    // a pose that has come so long ago is no longer shown as the present one

const by_id = (id) => document.getElementById(id);
const model = { samples: [], changes: [], pose: null, is_old: false, scan: null, particles: [], stored: [], transient: null, status: null, picked: null, wish: null, delta: null, run: null, until: null };
const shown = new Set(LAYERS.map((layer) => layer.id));

// --- dark and light: as the system, until a person says otherwise ---

const system_dark = matchMedia("(prefers-color-scheme: dark)");
function apply_theme() {
  document.documentElement.dataset.theme = localStorage.getItem("theme") ?? (system_dark.matches ? "dark" : "light");
}
apply_theme();

function is_drawn(layer) {
  const is_past = history.is_open && view.past;
  return shown.has(layer.id) && !(is_past && layer.is_of_now) && !(model.is_old && layer.is_gone_when_old);
}

/// What lies over the map: tools above, questions below, the pad where it is no mere corner, the open layers' box at the right. On a
/// phone all of them stand around it.
function covered() {
  const [map, tools, foot, pad, layers] = ["map", "map-tools", "map-foot", "pad", "layers-box"].map((id) => by_id(id).getBoundingClientRect());
  const below = [foot, ...(pad.width > map.width / 2 ? [pad] : [])].filter((box) => box.height);
  const is_beside = by_id("layers-box").open && layers.width && layers.top < map.bottom;
  return { top: Math.max(0, tools.bottom - map.top), bottom: Math.max(0, ...below.map((box) => map.bottom - box.top)),
           right: is_beside ? Math.max(0, map.right - layers.left) : 0 };
}

const view = new MapView(by_id("map"), (context) => {
  for (const layer of LAYERS) if (is_drawn(layer)) layer.draw(context, view, model);
  draw_delta(context, view, model);
  draw_wish(context, view, model);
  draw_drawing(context, view, model);
  draw_scale_bar(context, view);
}, covered);
const cover = new ResizeObserver(() => view.take_cover());
for (const id of ["map-tools", "map-foot", "pad", "layers-box"]) cover.observe(by_id(id));
const charts = new Charts(by_id("charts"), by_id("spans"), by_id("charts-instant"));

function take_theme() {
  apply_theme();
  fill_legend(by_id("layers"), shown, () => view.draw_soon());
  fill_delta_legend(by_id("history-keys"));
  view.repaint();
  charts.draw_soon();
}
by_id("theme").addEventListener("click", () => {
  localStorage.setItem("theme", document.documentElement.dataset.theme === "dark" ? "light" : "dark");
  take_theme();
});
system_dark.addEventListener("change", take_theme);
take_theme();

// --- what the words mean ---

for (const one of document.querySelectorAll("h2, summary, header button, #map-section button, [data-term]")) explain(one);

// --- the map's tools ---

if (innerWidth <= NARROW_PX) by_id("layers-box").open = false;
by_id("zoom-in").addEventListener("click", () => view.zoom(1.4));
by_id("zoom-out").addEventListener("click", () => view.zoom(1 / 1.4));
by_id("fit").addEventListener("click", () => view.fit());
by_id("follow").addEventListener("click", () => view.set_follow(!view.follows));
view.on_follow = (follows) => {
  by_id("follow").setAttribute("aria-pressed", String(follows));
  if (follows && model.pose) view.show(model.pose.x_m, model.pose.y_m);
};

function pick(change, button) {
  model.picked = model.picked === change ? null : change;
  if (run.is_open && model.picked) run.go(change.time);
  mark_picked(model.picked ? button : null);
  if (!model.picked || !change.accepted) history.close();
  else history.show(change.revision);
  if (!model.picked) return view.draw_soon();
  if (!has_place(change)) {
    if (!change.accepted) control.row.tell("It was refused before any cell was changed: nothing to show.");
    return view.draw_soon();
  }
  view.set_follow(false);
  const [left, bottom, right, top] = change.box_m;
  view.scale = Math.max(view.scale, Math.min(40, 0.4 * Math.min(view.free_room().wide, view.free_room().high) / Math.max(1, right - left, top - bottom)));
  view.show((left + right) / 2, (bottom + top) / 2);
}

const control = new Control(view, model);
const history = new History(view, model, control.row);
const incidents = new Incidents(() => is_live && !run.is_open);
const run = new Run(view, model, (message) => connection.take(message), (time) => {
  charts.until = time;
  charts.draw_soon();
});
/// One slider for time and revision: with a revision in view, the newest one of that time.

/// Shown where it is; a person who may command can take it back.
function pick_thing(thing, is_asked) {
  if (!is_asked) return view.draw_soon();
  control.row.hide();
  if (!thing) return view.draw_soon();
  view.set_follow(false);
  const { x_m, y_m, length_m } = outline_of(thing);
  view.scale = Math.max(view.scale, Math.min(40, 0.2 * Math.min(view.free_room().wide, view.free_room().high) / Math.max(0.5, length_m)));
  view.show(x_m, y_m);
  if (!may_command) return control.row.tell(`Thing ${thing.thing}: ${thing.words}`);
  const undo = `Undo thing ${thing.thing}`;
  control.row.ask(`Thing ${thing.thing}: ${thing.words}. Its cells can become what they were before it.`,
                  [[undo, () => control.row.run({ command: "undo", thing: thing.thing }, "taking it back …")]]);
}
let may_command = false;
const things = new Things(model, pick_thing);
const bays = new Bays(model, (bay) => {
  if (!bay) return view.draw_soon();
  view.set_follow(false);
  view.scale = Math.max(view.scale, 20);
  view.show(...middle_of(bay));
}, () => view.draw_soon());

const zones = new ZoneWatch(model, () => view.draw_soon());
const drawing = new Drawing(view, model, control.row, () => {
  bays.hurry();
  zones.ask();
});

run.on_walk = (time) => {
  if (!history.is_open) return;
  const before = model.changes.filter((change) => change.accepted && change.time <= time).map((change) => change.revision);
  const number = Math.max(history.oldest, ...before);
  if (number !== history.number) history.show(number);
};
charts.on_pick = (time) => { if (run.is_open) run.go(time); };

// --- what the daemon sends ---

function note(text) {
  by_id("map-note").hidden = !text;
  by_id("map-note").textContent = text;
}

let pose_came = 0;
let is_live = false;

/// A robot that is silent is not where it was. The past of a run is never old.
function look_at_age() {
  const is_old = !run.is_open && model.pose !== null && Date.now() - pose_came > OLD_MS;
  if (is_old === model.is_old) return;
  model.is_old = is_old;
  show_pose(model.pose, is_old);
  if (model.status_message) show_status(model.status_message, null, is_old);
  view.draw_soon();
}
setInterval(look_at_age, 500);

const on = {
  link(link) {
    show_link(link, model.run);
    control.link(link);
    is_live = link === "live";
    if (link === "lost") note(model.run ? "The program that shows this run has ended." : "No connection to the daemon. What is shown is old; trying again …");
    if (link === "live") note("");
  },
  hello(hello) {
    run.begin(hello.run);
    show_link("live", hello.run);
    charts.set_whole(Boolean(hello.run));
    document.title = hello.run ? `${hello.run.name} – deltamap` : `deltamap ${hello.version.split(" ")[0]}`;
    charts.thresholds = hello.thresholds;
    charts.method = hello.method;
    charts.instant = null;
    control.allow(hello.control);
    if (!hello.run) incidents.look();
    history.allow_undo(Boolean(hello.control));
    may_command = Boolean(hello.control);
    things.clear();
    bays.clear();
    zones.clear();
    if (!hello.control?.draw) drawing.end();
    history.close();
    model.samples.length = model.changes.length = 0;  // the stream begins with the past
    model.particles = model.stored = [];
    model.picked = null;
    clear_changes();
  },
  map(frame) { view.set_frame(frame); },
  cells(box) {
    model.revision = box.revision;
    view.set_cells(box);
    history.update();
  },
  pose(pose) {
    model.pose = pose;
    pose_came = Date.now();
    look_at_age();
    show_pose(pose, false);
    if (view.follows) view.show(pose.x_m, pose.y_m);
    if (run.told) show_run(model.run, run.told, pose, view.frame);
    view.draw_soon();
  },
  scan(scan) {  // a pose comes with it
    model.scan = scan;
    control.relocalize.update();
  },
  particles(particles) { model.particles = particles; },  // with the scan
  stored(stored) { model.stored = stored; view.draw_soon(); },
  transient(transient) { model.transient = transient; view.draw_soon(); },
  status(message) {
    const before = model.status, now = message.status;
    const passed_s = before ? now.since_start_s - before.since_start_s : 0;
    model.status = now;
    control.show(now);
    history.update();
    model.status_message = message;
    show_status(message, passed_s > 0 ? (now.localized - before.localized) / passed_s : null, model.is_old);
  },
  run(told) {
    run.show(told);
    history.update();
    show_run(model.run, told, model.pose, view.frame);
  },
  samples(rows) {
    model.samples.push(...rows);
    if (!run.is_open) model.samples.splice(0, model.samples.length - MOST_SAMPLES);
    charts.samples = model.samples;
    charts.draw_soon();
  },
  changes(message) {
    model.changes.push(...message.changes);
    add_changes(message, model.changes, pick);
    view.draw_soon();
  },
};

const connection = new Connection(on);
window.deltamap = { model, view, charts, control, drawing, history, run, connection };  // to look at in the browser's console
