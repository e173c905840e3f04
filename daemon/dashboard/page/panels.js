// SPDX-License-Identifier: Apache-2.0
// The status and the badges.

import { clock, date_and_clock } from "./time_text.js";

const GATE_WORDS = {
  searching: "the robot does not know where it is", lost: "the robot is lost", wrong: "the pose is called wrong",
  relocalized: "somebody has said where the robot is", disbelieved: "the pose is rather wrong",
  confirming: "the pose has to hold for a while first", doubtful: "P(pose right) is low",
  rival: "another place fits as well",
  spread: "the pose is too uncertain, or nothing in view holds it",
};
const LEVELS = { tracking: "good", global: "warn", lost: "bad", right: "good", undecided: "warn", wrong: "bad" };

const percent = (share) => `${(100 * share).toFixed(share > 0 && share < 0.01 ? 1 : 0)} %`;
const whole = (number) => Math.round(number).toLocaleString("en");

function duration(time_s) {
  const s = Math.round(time_s);
  if (s < 60) return `${s} s`;
  if (s < 3600) return `${Math.floor(s / 60)} min ${s % 60} s`;
  return `${Math.floor(s / 3600)} h ${Math.floor((s % 3600) / 60)} min`;
}

function badge(id, text, level, title = "") {
  const host = document.getElementById(id);
  if (host.textContent !== text) host.textContent = text;
  host.dataset.level = level;
  host.title = title;
}

const KINDS = { recording: "recording", folder: "finished run", map: "map" };

/// `run`: of hello, or null.
export function show_link(link, run) {
  const words = { connecting: "connecting", live: run ? KINDS[run.kind] : "live", lost: "no connection" };
  badge("badge-link", words[link], { connecting: "wait", live: "good", lost: "bad" }[link]);
  document.body.dataset.link = link;
}

/// `is_old`: no newer pose has come for a while.
export function show_pose(pose, is_old) {
  const since = `no pose since ${clock(pose.time)}`;
  if (is_old) {
    badge("badge-state", `was ${pose.state}`, "none", since);
    badge("badge-verdict", `pose was ${pose.verdict}`, "none", since);
    return badge("badge-gate", "–", "none", since);
  }
  badge("badge-state", pose.state, LEVELS[pose.state] ?? "none");
  badge("badge-verdict", `pose ${pose.verdict}`, LEVELS[pose.verdict] ?? "none");
  if (!pose.gate) return badge("badge-gate", "–", "none");
  if (pose.gate.open) return badge("badge-gate", "gate open", "good", "the map may be written");
  badge("badge-gate", `gate closed: ${pose.gate.reason}`, "warn", `the map is not written: ${GATE_WORDS[pose.gate.reason] ?? pose.gate.reason}`);
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
  const blocks = status.temporary.standing_blocks + status.temporary.gone_blocks;
  const differs = blocks ? `${whole(blocks)} blocks differ` : "nothing differs";
  return status.phase.open ? `${differs}; Δ-phase ${status.phase.number}, ${status.phase.stored_scans} scans` : differs;
}

function gate_words(status) {
  if (status.mapping !== "on") return `mapping is ${status.mapping}`;
  return status.gate.open ? "open" : `closed: ${GATE_WORDS[status.gate.reason] ?? status.gate.reason}`;
}

/// Who drives and why it stands, and what planners are told of the pose.
export function driving_rows({ drive, stopped_by, never_driven, may_drive_by_pose, forbidden_by }) {
  const standing = drive === "off" || stopped_by === "none" ? drive : `${drive}; stands: ${stopped_by}`;
  return [
    ["Driving", never_driven ? `not driven: ${never_driven}` : standing],
    ["Planners", may_drive_by_pose ? "may drive by this pose" : `must not drive by this pose: ${forbidden_by}`],
  ];
}

function rows_of({ status, resident_bytes }, rate) {
  const { pose, belief, covariance } = status;
  const deviation = Math.sqrt(Math.max(covariance.xx_m2, covariance.yy_m2));
  const drops = Object.values(status.drops).reduce((sum, count) => sum + count, 0);
  return [
    ["P(pose right)", share_bar(belief.pose_right)],
    ["P(map wrong)", share_bar(belief.map_wrong)],
    ["Scan fits", status.fit === null ? "–" : share_bar(status.fit)],
    ["Write gate", gate_words(status)],
    ["Waits", waiting_words(status)],
    ["Revision", `M${status.newest_revision}` + (status.newest_revision === status.revision ? "" : `, pose on M${status.revision}`) + (status.refused ? `; ${status.refused} refused` : "")],
    ["Pose", `${pose.x_m.toFixed(2)}, ${pose.y_m.toFixed(2)} m, ${pose.heading_deg.toFixed(0)}°; σ ${(100 * deviation).toFixed(1)} cm`],
    ["Scans", (rate === null ? "–" : rate > 0 ? `${rate.toFixed(1)} a second` : "none come") + (drops ? `; ${whole(drops)} dropped` : "")],
    ["Latency", `${status.latency_ms.toFixed(1)} ms`],
    ["Particles", `${whole(status.particles)}; N_eff ${status.n_eff.toFixed(0)}`],
    ["Ports", `robot ${status.ports.robot}, laser ${status.ports.laser}`],
    ...driving_rows(status),
    ["Battery", status.battery_v > 0 ? `${status.battery_v.toFixed(1)} V` : "–"],
    ["Memory", `${(resident_bytes / 1048576).toFixed(1)} MiB`],
    ["Runs for", duration(status.since_start_s)],
  ];
}

function problems_of(status) {
  const problems = Object.entries(status.outputs).filter(([, output]) => !output.written).map(([name, output]) => `${name} is not written: ${output.why}`);
  for (const [port, state] of Object.entries(status.ports)) if (state === "down") problems.push(`${port} does not answer`);
  return problems;
}

/// Rows of a run that is over, at the time that is shown. `pose` is null where it has no scans.
function rows_of_run(run, told, pose, frame) {
  const rows = [["Of", run.name]];
  if (frame) rows.push(["Map", `M${told.revision}; ${whole(frame.width)} × ${whole(frame.height)} cells of ${+(100 * frame.resolution_m).toFixed(1)} cm`]);
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

export function show_status(message, rate) {
  show_rows(rows_of(message, rate));
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
      return [title, document.createElement("dd")];
    }));
  }
  rows.forEach(([, value], i) => host.children[2 * i + 1].replaceChildren(...(Array.isArray(value) ? value : [value])));
}
