// SPDX-License-Identifier: Apache-2.0
// The buttons that command. They are there where the daemon takes commands from the page; STOP is never covered.

import { command, TaskRow } from "./commands.js";
import { HandDrive, hindrance_of } from "./drive.js";
import { Relocalize } from "./relocalize.js";
import { ask_token, is_locked } from "./token.js";

const STOP_PATIENCE_MS = 2000;  // of one try
const STOP_TRIES_MS = 10000;    // of all of them
const STOP_PAUSE_MS = 100;

const by_id = (id) => document.getElementById(id);

export class Control {
  constructor(view, model) {
    this.model = model;
    this.row = new TaskRow(by_id("task"));
    this.relocalize = new Relocalize(view, model, this.row, () => this.mark());
    this.hand = new HandDrive(by_id("pad"), (why) => {
      this.mark();
      this.row.tell(`No longer driven by hand: ${why}. The robot stands.`, "warn");
    });
    by_id("stop").addEventListener("click", () => this.stop());
    by_id("save").addEventListener("click", () => this.row.run({ command: "save" }, "saving …"));
    by_id("pause").addEventListener("click", () => this.pause());
    by_id("mark").addEventListener("click", () => this.row.run({ command: "mark" }, "keeping this moment …"));
    by_id("record").addEventListener("click", () => this.record());
    by_id("unlock").addEventListener("click", () => ask_token(this.row));
    by_id("relocalize").addEventListener("click", () => (this.relocalize.is_on ? this.relocalize.end() : this.relocalize.begin()));
    by_id("wander").addEventListener("click", () => this.wander());
    by_id("drive").addEventListener("click", () => this.drive());
  }

  /// `allowed`: null, or {drive}.
  async allow(allowed) {
    by_id("controls").hidden = !allowed;
    by_id("drive").hidden = by_id("wander").hidden = !allowed?.drive;
    this.draws = Boolean(allowed?.draw);
    this.set_locked(Boolean(allowed) && await is_locked());
  }

  /// Buttons that would be refused are not there; STOP needs no token.
  set_locked(is_locked) {
    by_id("unlock").hidden = !is_locked;
    by_id("controls").classList.toggle("locked", is_locked);
    by_id("draw").hidden = is_locked || !this.draws;
  }

  link(link) {
    for (const button of [...by_id("controls").querySelectorAll("button:not(#stop)"), by_id("draw")]) button.disabled = link !== "live";
    if (link === "lost") this.hand.end("the connection is lost");
  }

  show(status) {
    const has_zones = this.model.zones.some(({ zoneType }) => zoneType === "BLOCKED" || zoneType === "SPEED_LIMIT");
    this.hand.tell(hindrance_of(status, has_zones));
    this.mapping = status.mapping;
    by_id("pause").textContent = status.mapping === "paused" ? "Resume mapping" : "Pause mapping";
    by_id("pause").disabled = status.mapping !== "paused" && status.mapping !== "on";
    by_id("record").hidden = !status.recording;
    this.records = Boolean(status.recording?.goes_on);
    by_id("record").textContent = this.records ? "Stop recording" : "Record";
    by_id("stop").dataset.drives = String(status.drive !== "off");
  }

  mark() {
    by_id("relocalize").setAttribute("aria-pressed", String(this.relocalize.is_on));
    by_id("drive").setAttribute("aria-pressed", String(this.hand.drives));
  }

  /// First of all, and whatever else is going on; again until the daemon says that it is done.
  async stop() {
    this.hand.end("STOP");
    this.row.tell("stopping …", "wait", 60000);
    const stop = () => command({ command: "drive", mode: "off" }, STOP_PATIENCE_MS);
    let answer = await stop();
    for (const began = performance.now(); !answer.ok && performance.now() - began < STOP_TRIES_MS;) {
      await new Promise((resolve) => setTimeout(resolve, STOP_PAUSE_MS));
      answer = await stop();
    }
    if (answer.ok) this.row.tell(`STOP: ${answer.message}`, "good");
    else this.row.tell(`STOP: ${answer.error}. Press STOP on the robot.`, "bad", 60000);
  }

  async pause() {
    const to = this.mapping === "paused" ? "resume" : "pause";
    await this.row.run({ command: to }, `${to} …`);
  }

  async record() {
    const mode = this.records ? "stop" : "start";
    await this.row.run({ command: "record", mode }, `${mode === "stop" ? "stopping" : "starting"} the recording …`);
  }

  wander() {
    this.row.ask("Let the robot drive about by itself?", [["Let it drive", () => this.row.run({ command: "drive", mode: "wander" }, "switching on …")]]);
  }

  drive() {
    if (this.hand.drives) return this.hand.end("ended here");
    this.row.ask("Take the robot in hand? Its motors come on; the pilot stays off until somebody says wander.", [["Drive by hand", () => {
      this.row.hide();
      this.hand.begin();
      this.mark();
    }]]);
  }
}
