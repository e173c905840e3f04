// SPDX-License-Identifier: Apache-2.0
// Commands to the daemon, as `deltamap ctl` gives them, and what it answers.

import { explain } from "./glossary.js";

const PATIENCE_MS = 5000;

/// {ok: true, message} with `doubt` where one should look again, or {ok: false, error} with `is_locked` where the token is
/// missing; never throws.
export async function command(request, patience_ms = PATIENCE_MS) {
  try {
    const answer = await fetch("/api/command", {
      method: "POST", headers: { "Content-Type": "application/json" }, body: JSON.stringify(request),
      signal: AbortSignal.timeout(patience_ms),
    });
    const text = await answer.text();
    if (answer.headers.get("Content-Type") === "application/json") return JSON.parse(text);
    return { ok: false, error: text.trim() || `answer ${answer.status}`, is_locked: answer.status === 401 };
  } catch (error) {
    return { ok: false, error: error.name === "TimeoutError" ? "no answer from the daemon" : "the daemon cannot be reached" };
  }
}

/// The row on the map that tells what became of something, or asks before it is done.
export class TaskRow {
  constructor(host) {
    this.host = host;
    this.text = host.querySelector(".task-text");
    this.buttons = host.querySelector(".task-buttons");
    this.timer = null;
    this.on_cancel = null;
    host.addEventListener("keydown", (event) => {
      if (event.key === "Escape" && this.on_cancel) this.cancel();
    });
  }

  tell(text, level = "none", for_ms = 8000) {
    this.set(text, level, []);
    this.timer = setTimeout(() => this.hide(), for_ms);
  }

  /// `choices`: [label, function] each; "Cancel" comes with them, and Escape.
  ask(text, choices, on_cancel = () => {}) {
    this.set(text, "none", [...choices, ["Cancel", () => this.cancel()]]);
    this.on_cancel = on_cancel;
    if (document.activeElement?.tagName !== "CANVAS") this.buttons.firstChild.focus();  // by keyboard alone: Enter, or Escape
  }

  set_text(text) { this.text.textContent = text; }

  cancel() {
    const then = this.on_cancel;
    this.hide();
    then?.();
  }

  hide() {
    clearTimeout(this.timer);
    this.on_cancel = null;
    this.host.hidden = true;
  }

  set(text, level, choices) {
    clearTimeout(this.timer);
    this.on_cancel = null;
    this.text.textContent = text;
    this.host.dataset.level = level;
    this.buttons.replaceChildren(...choices.map(([label, act]) => {
      const button = document.createElement("button");
      button.type = "button";
      button.textContent = label;
      explain(button, label.replace(/ (M|thing )\d+$/, ""));
      button.addEventListener("click", act);
      return button;
    }));
    this.host.hidden = false;
  }

  /// Gives a command and tells what became of it.
  async run(request, doing) {
    this.tell(doing, "wait", 60000);
    const answer = await command(request);
    if (answer.ok) this.tell(answer.message || "done", answer.doubt ? "warn" : "good", answer.doubt ? 20000 : 8000);
    else this.tell(answer.error, "bad", 20000);
    return answer;
  }
}
