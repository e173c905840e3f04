// SPDX-License-Identifier: Apache-2.0
// The status and the badges.

import { explain } from "./glossary.js";
import { clock, date_and_clock } from "./time_text.js";

const GATE_WORDS = {
  searching: "the robot does not know where it is", lost: "the robot is lost", wrong: "the pose is called wrong",
  relocalized: "somebody has said where the robot is", disbelieved: "the pose is rather wrong",
  confirming: "the pose has to hold for a while first", doubtful: "P(pose right) is low",
  rival: "another place fits as well",
  spread: "the pose is too uncertain, or nothing in view holds it",
  wheels: "wheels and scans contradict each other", mount: "the laser is mounted otherwise than set",
  scale: "ranges and map differ in scale",
  "no scans": "no scans come", off: "mapping is off", paused: "mapping is paused",
};
const IS_NO_GATE = { "no scans": "no scans", off: "mapping off", paused: "mapping paused" };  // nothing votes at all
// Amber calls for a look: what is normal for minutes is calm.
const LEVELS = { tracking: "good", global: "warn", lost: "bad", right: "good", undecided: "calm", wrong: "bad" };
const GATE_LEVELS = {
  lost: "warn", wrong: "warn", disbelieved: "warn", wheels: "warn", mount: "warn", scale: "warn",
};  // any other reason is calm

const UNKNOWN = "–";

const percent = (share) => `${(100 * share).toFixed(share > 0 && share < 0.01 ? 1 : 0)} %`;
const whole = (number) => Math.round(number).toLocaleString("en");

function duration(time_s) {
  const s = Math.round(time_s);
  if (s < 60) return `${s} s`;
  if (s < 3600) return `${Math.floor(s / 60)} min ${s % 60} s`;
  return `${Math.floor(s / 3600)} h ${Math.floor((s % 3600) / 60)} min`;
}

/// `term`: of the glossary.
function badge(id, text, level, term, detail = "") {
  const host = document.getElementById(id);
  if (host.textContent !== text) host.textContent = text;
  host.dataset.level = level;
  explain(host, term, detail);
}

const KINDS = { recording: "recording", folder: "finished run", map: "map" };

/// `run`: of hello, or null.
export function show_link(link, run) {
  const words = { connecting: "connecting", live: run ? KINDS[run.kind] : "live", lost: "no connection" };
  badge("badge-link", words[link], { connecting: "wait", live: "good", lost: "bad" }[link], words[link]);
  document.body.dataset.link = link;
}

/// `is_old`: no newer pose has come for a while.
export function show_pose(pose, is_old) {
  const since = is_old ? `No pose since ${clock(pose.time)}.` : "";
  badge("badge-state", is_old ? `was ${pose.state}` : pose.state, is_old ? "none" : LEVELS[pose.state] ?? "none", pose.state, since);
  badge("badge-verdict", is_old ? `pose was ${pose.verdict}` : `pose ${pose.verdict}`, is_old ? "none" : LEVELS[pose.verdict] ?? "none", pose.verdict, since);
  if (is_old || pose.gate) show_gate(is_old ? { reason: "no scans" } : pose.gate);
}

/// `gate`: of a pose or of the status.
function show_gate({ open, reason }) {
  if (open) return badge("badge-gate", "gate open", "good", "write gate", "The map may be written.");
  const why = `The map is not written: ${GATE_WORDS[reason] ?? reason}.`;
  if (IS_NO_GATE[reason]) return badge("badge-gate", IS_NO_GATE[reason], "none", "write gate", why);
  badge("badge-gate", `gate closed: ${reason}`, GATE_LEVELS[reason] ?? "calm", "write gate", why);
}

function share_bar(share) {
  const bar = document.createElement("span");
  bar.className = "bar";
  const filled = document.createElement("i");
  filled.style.width = `${Math.round(100 * share)}%`;
  bar.append(filled);
  return [bar, percent(share)];
}

function waiting_words(status) {
  if (!status.pose || status.mapping !== "on") return UNKNOWN;
  const blocks = status.temporary.standing_blocks + status.temporary.gone_blocks;
  const differs = blocks ? `${whole(blocks)} ${blocks === 1 ? "block differs" : "blocks differ"}` : "nothing differs";
  return status.phase.open ? `${differs}; Δ-phase ${status.phase.number}, ${status.phase.stored_scans} scans` : differs;
}

const gate_words = ({ gate: { open, reason } }) => (open ? "open" : `closed: ${GATE_WORDS[reason] ?? reason}`);

/// "robot up, laser down: no such device": `port_troubles` tells why.
function port_words({ ports, port_troubles = {} }) {
  const why = (name) => (ports[name] === "down" && port_troubles[name] ? `: ${port_troubles[name]}` : "");
  return Object.keys(ports).map((name) => `${name} ${ports[name]}${why(name)}`).join("; ");
}

/// What is true of a pose that is no longer the present one is its place alone.
function pose_rows({ pose, belief, covariance, fit }, is_old) {
  const of_now = (value) => (pose && !is_old ? value() : UNKNOWN);
  const place = () => `${pose.x_m.toFixed(2)}, ${pose.y_m.toFixed(2)} m, ${pose.heading_deg.toFixed(0)}°`;
  const deviation = () => `; σ ${(100 * Math.sqrt(Math.max(covariance.xx_m2, covariance.yy_m2))).toFixed(1)} cm`;
  return {
    belief: [
      ["P(pose right)", of_now(() => share_bar(belief.pose_right))],
      ["P(map wrong)", of_now(() => share_bar(belief.map_wrong))],
      ["Scan fits", of_now(() => (fit === null ? UNKNOWN : share_bar(fit)))],
    ],
    place: ["Pose", !pose ? UNKNOWN : is_old ? `was ${place()}` : place() + deviation()],
  };
}

const scan_words = (rate, drops) => (rate === null ? UNKNOWN : rate > 0 ? `${rate.toFixed(1)} a second` : "none come") + (drops ? `; ${whole(drops)} dropped` : "");

function revision_words({ newest_revision, revision, refused }) {
  const other = revision === null || revision === newest_revision ? "" : `, pose on M${revision}`;
  return `M${newest_revision}${other}` + (refused ? `; ${refused} refused` : "");
}

/// Who drives and why it stands, and what planners are told of the pose.
export function driving_rows({ drive, stopped_by, never_driven, may_drive_by_pose, forbidden_by }) {
  const standing = drive === "off" || stopped_by === "none" ? drive : `${drive}; stands: ${stopped_by}`;
  return [
    ["Driving", never_driven ? `not driven: ${never_driven}` : standing],
    ["Planners", may_drive_by_pose ? "may drive by this pose" : `must not drive by this pose: ${forbidden_by}`],
  ];
}

function rows_of({ status, resident_bytes }, rate, is_old) {
  const rows = pose_rows(status, is_old), is_now = status.pose && !is_old;
  const drops = Object.values(status.drops).reduce((sum, count) => sum + count, 0);
  return [
    ...rows.belief,
    ["Write gate", gate_words(status)],
    ["Waits", waiting_words(status)],
    ["Revision", revision_words(status)],
    rows.place,
    ["Scans", scan_words(rate, drops)],
    ["Latency", is_now ? `${status.latency_ms.toFixed(1)} ms` : UNKNOWN],
    ["Particles", is_now ? `${whole(status.particles)}; N_eff ${status.n_eff.toFixed(0)}` : UNKNOWN],
    ["Ports", port_words(status)],
    ...driving_rows(status),
    ["Battery", status.battery_v === null ? UNKNOWN : `${status.battery_v.toFixed(1)} V`],
    ["Memory", resident_bytes ? `${(resident_bytes / 1048576).toFixed(1)} MiB` : UNKNOWN],
    ["Runs for", duration(status.since_start_s)],
  ];
}

function problems_of(status) {
  const problems = Object.entries(status.outputs).filter(([, output]) => !output.written).map(([name, output]) => `${name} is not written: ${output.why}`);
  for (const [port, state] of Object.entries(status.ports)) if (state === "down") problems.push(`${port} does not answer${status.port_troubles?.[port] ? `: ${status.port_troubles[port]}` : ""}`);
  return problems;
}

/// Rows of a run that is over, at the time that is shown. `pose` is null where it has no scans.
function rows_of_run(run, told, pose, frame) {
  const rows = [["Of", run.name]];
  if (frame) rows.push(["Revision", `M${told.revision}; ${whole(frame.width)} × ${whole(frame.height)} cells of ${+(100 * frame.resolution_m).toFixed(1)} cm`]);
  if (told.from === null || !pose) return rows;
  const deviation = Math.sqrt(Math.max(pose.covariance.xx_m2, pose.covariance.yy_m2));
  return [...rows,
    ["Began", date_and_clock(told.from)],
    ["Length", `${duration(told.to - told.from)}, ${whole(told.scans)} scans`],
    ["Shown", `scan ${whole(pose.scan)}, pose on M${pose.revision}`],
    ["P(pose right)", share_bar(pose.pose_right)],
    ["P(map wrong)", share_bar(pose.map_wrong)],
    ["Pose", `${pose.x_m.toFixed(2)}, ${pose.y_m.toFixed(2)} m, ${(pose.heading_rad * 180 / Math.PI).toFixed(0)}°; σ ${(100 * deviation).toFixed(1)} cm`],
    ["Speed", `${(Math.round(100 * pose.speed_m_per_s) / 100 || 0).toFixed(2)} m/s`],
  ];
}

export function show_run(run, told, pose, frame) { show_rows(rows_of_run(run, told, pose, frame)); }

/// `is_old`: no newer pose has come for a while.
export function show_status(message, rate, is_old) {
  show_rows(rows_of(message, rate, is_old));
  show_gate(is_old ? { reason: "no scans" } : message.status.gate);
  const problems = problems_of(message.status), alert = document.getElementById("problems");
  alert.hidden = !problems.length;
  if (alert.textContent !== problems.join("; ")) alert.textContent = problems.join("; ");
}

function show_rows(rows) {
  const host = document.getElementById("status");
  const names = rows.map(([name]) => name).join();
  if (host.dataset.names !== names) {
    host.dataset.names = names;
    host.replaceChildren(...rows.flatMap(([name]) => {
      const title = document.createElement("dt");
      title.textContent = name;
      explain(title);
      return [title, document.createElement("dd")];
    }));
  }
  rows.forEach(([, value], i) => host.children[2 * i + 1].replaceChildren(...(Array.isArray(value) ? value : [value])));
}
