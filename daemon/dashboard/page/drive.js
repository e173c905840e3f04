// SPDX-License-Identifier: Apache-2.0
// Driving by hand (docs/api.md, /drive): while keys or the pad are held the robot moves. The daemon asks ten times a
// second; whatever keeps the answer from it (a lost connection, a closed or hidden tab) makes the robot stand.

const SPEED_M_PER_S = 0.25, TURN_RAD_PER_S = 0.7;
const STICK_PX = 42;     // drag for full speed
const DEAD_SHARE = 0.12; // of it that is no wish
const SILENCE_MS = 1000; // of the daemon
const USE = "drag or hold; keys ← ↑ →; Esc ends";
const KEYS = { ArrowUp: "ahead", KeyW: "ahead", ArrowLeft: "left", KeyA: "left", ArrowRight: "right", KeyD: "right" }; // by place

const IS_AT_REST = ["none", "no command", "command expired"];

/// Why a hand does not get what it wants; empty: nothing is in its way. `has_zones`: some that whoever drives heeds.
export function hindrance_of({ stopped_by, zone_limit_m_per_s, may_drive_by_pose, forbidden_by }, has_zones) {
  if (stopped_by === "blocked zone") return "a blocked zone begins here: turn away";
  if (!IS_AT_REST.includes(stopped_by)) return `it stands: ${stopped_by}`;
  if (has_zones && !may_drive_by_pose) return `zones are not heeded: ${forbidden_by}`;
  return zone_limit_m_per_s === null ? "" : `slow zone: at most ${zone_limit_m_per_s} m/s`;
}

export class HandDrive {
  /// `on_end(why)` when it is over, by whom ever; `pad` holds a button for each of ahead, left, right (data-go) and the stick, which is dragged.
  constructor(pad, on_end) {
    this.pad = pad;
    this.on_end = on_end;
    this.held = new Set();
    this.pull = null;  // of the stick: {pointer, from, turn, speed}, shares of the full ones
    this.socket = null;
    document.addEventListener("keydown", (event) => this.take_key(event, true), true);
    document.addEventListener("keyup", (event) => this.take_key(event, false), true);
    for (const button of pad.querySelectorAll("[data-go]")) this.take_button(button);
    this.take_stick(pad.querySelector("#stick"));
    addEventListener("blur", () => this.release());
    document.addEventListener("visibilitychange", () => { if (document.hidden) this.end("the tab was hidden"); });
    addEventListener("pagehide", () => this.end("the page was left"));
  }

  get drives() { return this.socket !== null; }

  begin() {
    if (this.drives || document.hidden) return;
    this.held.clear();
    this.beat = null;
    const socket = new WebSocket(`ws://${location.host}/drive`);
    this.socket = socket;
    socket.onmessage = (event) => { if (socket === this.socket) this.hear(JSON.parse(event.data)); };
    socket.onclose = () => { if (socket === this.socket) this.end("the connection is lost"); };
    this.await_beat();
  }

  hear(message) {
    if (message.type === "taken") {
      this.pad.hidden = false;
      this.tell("");
      this.pad.querySelector("[data-go]").focus();
    } else if (message.type === "beat") {
      this.beat = message.number;
      this.await_beat();
      this.speak();
    } else {
      this.end(message.why);
    }
  }

  await_beat() {
    clearTimeout(this.timer);
    this.timer = setTimeout(() => this.end("the daemon is not heard"), SILENCE_MS);
  }

  /// What keeps the robot from what the hand wants, as of a status.
  tell(words) { if (this.drives) this.pad.querySelector("small").textContent = words || USE; }

  /// Nothing is piled up: what cannot leave now would come too late.
  speak() {
    if (this.beat === null || this.socket?.readyState !== WebSocket.OPEN || this.socket.bufferedAmount > 0) return;
    const keys = (this.held.has("left") ? 1 : 0) - (this.held.has("right") ? 1 : 0);
    const turn = Math.max(-1, Math.min(1, keys + (this.pull?.turn ?? 0)));
    const speed = this.held.has("ahead") ? 1 : this.pull?.speed ?? 0;
    this.socket.send(JSON.stringify({ beat: this.beat, speed_m_per_s: speed * SPEED_M_PER_S, turn_rate_rad_per_s: turn * TURN_RAD_PER_S }));
  }

  hold(way, is_held) {
    if (is_held === this.held.has(way)) return;
    if (is_held) this.held.add(way); else this.held.delete(way);
    this.pad.querySelector(`[data-go="${way}"]`).classList.toggle("held", is_held);
    this.speak();
  }

  release() {
    for (const way of [...this.held]) this.hold(way, false);
    this.set_pull(null);
  }

  /// A pull that begins or ends is told at once, what it becomes in between with the next beat: a mouse moves more often
  /// than the daemon listens to.
  set_pull(pull) {
    const is_news = Boolean(pull) !== Boolean(this.pull);
    this.pull = pull;
    const stick = this.pad.querySelector("#stick");
    stick.classList.toggle("held", Boolean(pull));
    stick.firstElementChild.style.transform = pull ? `translate(${-pull.turn * STICK_PX}px, ${-pull.speed * STICK_PX}px)` : "";
    if (is_news) this.speak();
  }

  end(why) {
    if (!this.drives) return;
    const socket = this.socket;
    this.release();
    this.socket = null;
    clearTimeout(this.timer);
    socket.close();
    this.pad.hidden = true;
    this.on_end(why);
  }

  take_key(event, is_down) {
    if (!this.drives || this.pad.hidden) return;
    if (is_down && event.key === "Escape") {
      event.preventDefault();
      return this.end("ended by Escape");
    }
    // A release under a modifier counts; and some systems never tell of one.
    if (is_down && (event.ctrlKey || event.metaKey || event.altKey)) return this.release();
    const way = KEYS[event.code];
    if (!way) return;
    event.preventDefault();
    event.stopPropagation(); // the map does not move as well
    this.hold(way, is_down);
  }

  /// Across is turning, up is speed; there is no reverse.
  take_stick(stick) {
    const share = (px) => {
      const size = Math.min(1, Math.abs(px) / STICK_PX);
      return size < DEAD_SHARE ? 0 : Math.sign(px) * size;
    };
    stick.addEventListener("pointerdown", (event) => {
      if (this.pull) return;
      event.preventDefault();
      stick.setPointerCapture(event.pointerId);
      this.set_pull({ pointer: event.pointerId, from: [event.clientX, event.clientY], turn: 0, speed: 0 });
    });
    stick.addEventListener("pointermove", (event) => {
      if (this.pull?.pointer !== event.pointerId) return;
      const [x, y] = this.pull.from;
      this.set_pull({ ...this.pull, turn: -share(event.clientX - x) || 0, speed: Math.max(0, share(y - event.clientY)) });
    });
    for (const end of ["pointerup", "pointercancel", "lostpointercapture"]) {
      stick.addEventListener(end, (event) => { if (this.pull?.pointer === event.pointerId) this.set_pull(null); });
    }
    stick.addEventListener("contextmenu", (event) => event.preventDefault());
  }

  take_button(button) {
    const way = button.dataset.go;
    button.addEventListener("pointerdown", (event) => {
      event.preventDefault();
      button.setPointerCapture(event.pointerId);
      this.hold(way, true);
    });
    for (const end of ["pointerup", "pointercancel", "lostpointercapture"]) {
      button.addEventListener(end, () => this.hold(way, false));
    }
    button.addEventListener("contextmenu", (event) => event.preventDefault());
  }
}
