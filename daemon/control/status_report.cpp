// SPDX-License-Identifier: Apache-2.0
#include "daemon/control/status_report.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

#include "core/geometry/angle.hpp"
#include "daemon/control/calibration_json.hpp"
#include "daemon/telemetry/log_level.hpp"
#include "drivers/pioneer/drive_permission.hpp"
#include "navigation/drive_mode.hpp"
#include "navigation/safety.hpp"

namespace deltamap::daemon::control {
namespace {

using Json = nlohmann::ordered_json;

Json pose_json(double x_m, double y_m, double heading_rad) {
  return {{"x_m", x_m}, {"y_m", y_m}, {"heading_deg", degrees(heading_rad)}};
}

Json counts_json(const BeamCounts& beams) {
  return {{"expected", beams.expected}, {"fit", beams.fit}, {"short_of", beams.short_of}, {"beyond", beams.beyond}};
}

Json belief_json(const EstimateGauges& estimate) {
  Json json;
  json["verdict"] = name_of(static_cast<PoseVerdict>(estimate.verdict.value()));
  json["pose_right"] = estimate.pose_right.value();
  json["map_wrong"] = estimate.map_wrong.value();
  json["stable"] = counts_json(estimate.stable.value());
  json["elsewhere"] = counts_json(estimate.elsewhere.value());
  json["rival"] = nullptr;
  if (const double share = estimate.other_share.value(); share > 0.0) {
    json["rival"] =
        pose_json(estimate.other_x_m.value(), estimate.other_y_m.value(), estimate.other_heading_rad.value());
    json["rival"]["share"] = share;
  }
  return json;
}

void add_estimate(Json& json, const Telemetry& t) {
  const EstimateGauges& estimate = t.estimate;
  const auto covariance = [&](std::size_t i) { return estimate.covariance[i].value(); };
  const bool is_known = t.localized.value() > 0;
  json["state"] = is_known ? Json(name_of(static_cast<LocalizerState>(estimate.state.value()))) : Json("no scan yet");
  for (const char* name : {"pose", "covariance", "belief", "particles", "n_eff", "w_avg", "fit", "revision"}) {
    json[name] = nullptr;
  }
  if (!is_known) return;
  json["pose"] = pose_json(estimate.x_m.value(), estimate.y_m.value(), estimate.heading_rad.value());
  json["covariance"] = {{"xx_m2", covariance(0)}, {"xy_m2", covariance(1)},    {"xh_m_rad", covariance(2)},
                        {"yy_m2", covariance(3)}, {"yh_m_rad", covariance(4)}, {"hh_rad2", covariance(5)}};
  json["belief"] = belief_json(estimate);
  json["particles"] = estimate.particles.value();
  json["n_eff"] = estimate.n_eff.value();
  json["revision"] = estimate.revision.value();
  if (t.fit.value() < 0.0) return;  // no beam tells; the weight is an older scan's
  json["w_avg"] = estimate.w_avg.value();
  json["fit"] = t.fit.value();
}

/// Where no scan votes, the gate's last word tells nothing.
Json gate_json(const Telemetry& t, const Settings& settings) {
  const auto now = gate_now(t, settings.mapping.enabled);
  const mapping::gate::GateTimes times = t.gate.times();
  Json json;
  json["open"] = false;
  if (!now) {
    json["reason"] = settings.mapping.enabled ? "paused" : "off";
  } else if (t.localized.value() == 0 || !t.laser_up.value()) {
    json["reason"] = "no scans";
  } else {
    json["open"] = *now == mapping::gate::GateReason::kOpen;
    json["reason"] = *now == mapping::gate::GateReason::kOpen ? Json(nullptr) : Json(name_of(*now));
  }
  json["observed_s"] = mapping::gate::observed_s(times);
  json["shut_s"] = mapping::gate::shut_by_reason(times);
  return json;
}

/// Why each device that is down does not answer.
Json port_troubles_json(const Telemetry& t) {
  Json json = Json::object();
  if (!t.robot_up.value()) json["robot"] = t.robot_trouble.line();
  if (!t.laser_up.value()) json["laser"] = t.laser_trouble.line();
  return json;
}

const char* mapping_word(const Telemetry& t, const Settings& settings) {
  if (!settings.mapping.enabled) return "off";
  return t.paused.value() ? "paused" : "on";
}

Json recording_json(const Telemetry& t, const Settings& settings) {
  if (settings.recording.file.empty()) return nullptr;
  return {{"file", settings.recording.file}, {"bytes", t.recorded_bytes.value()}, {"goes_on", t.records.value()}};
}

/// Each output by name: whether it is being written; where not, since when and why.
Json outputs_json(const Telemetry& t) {
  Json json = Json::object();
  for (const OutputStatus& output : t.outputs.all()) {
    Json& told = json[output.name];
    told = {{"file", output.file}, {"written", output.written}, {"lost", output.lost}};
    if (output.written) continue;
    told["since"] = unix_seconds(output.since);
    told["why"] = output.why;
  }
  return json;
}

}  // namespace

std::string status_json_line(const Telemetry& t, const Settings& settings, double since_start_s) {
  Json json;
  json["ok"] = true;
  add_estimate(json, t);
  json["mapping"] = mapping_word(t, settings);
  json["newest_revision"] = t.newest_revision.value();
  json["refused"] = t.refused.value();
  json["phase"] = {{"number", t.phase.value()},
                   {"open", t.in_phase.value()},
                   {"stored_scans", t.stored_scans.value()},
                   {"r_d", t.r_d.value()}};
  json["temporary"] = {{"standing_blocks", t.transients_standing.value()}, {"gone_blocks", t.transients_gone.value()}};
  json["gate"] = gate_json(t, settings);
  json["calibration"] = Json::parse(calibration_json(t.calibration.get()));
  json["scans"] = t.scans.value();
  json["localized"] = t.localized.value();
  json["odometry"] = t.odometry.value();
  for (const auto& [name, count] : drops_of(counts_of(t))) json["drops"][name] = count;
  json["ports"] = {{"robot", t.robot_up.value() ? "up" : "down"}, {"laser", t.laser_up.value() ? "up" : "down"}};
  json["port_troubles"] = port_troubles_json(t);
  json["drive"] = !t.drives.value()   ? "off"
                  : t.by_hand.value() ? "by hand"
                                      : navigation::name_of(settings.navigation.mode);
  json["drive_switch"] = drivers::pioneer::name_of(static_cast<drivers::pioneer::DriveSwitch>(t.drive_switch.value()));
  json["never_driven"] = t.robot_up.value() ? t.never_driven.line() : "";
  json["stopped_by"] = navigation::name_of(static_cast<navigation::StopReason>(t.stop_reason.value()));
  const navigation::StopReason forbids = forbidden_by(t);
  json["may_drive_by_pose"] = forbids == navigation::StopReason::kNone;
  json["forbidden_by"] = navigation::name_of(forbids);
  json["told"] = {{"speed_m_per_s", t.told_speed_m_per_s.value()},
                  {"turn_rate_rad_per_s", t.told_turn_rate_rad_per_s.value()}};
  const double zone_limit = t.zone_limit_m_per_s.value();
  json["zone_limit_m_per_s"] = zone_limit > 0.0 && std::isfinite(zone_limit) ? Json(zone_limit) : Json(nullptr);
  const auto battery_v = told_battery_v(t);
  json["battery_v"] = battery_v ? Json(*battery_v) : Json(nullptr);
  json["latency_ms"] = t.localized.value() > 0 ? Json(t.latency_s.value() * 1e3) : Json(nullptr);
  json["since_start_s"] = since_start_s;
  json["log_level"] = name_of(static_cast<LogLevel>(t.log_level.value()));
  json["line"] = status_line(t);
  json["recording"] = recording_json(t, settings);
  json["outputs"] = outputs_json(t);
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace deltamap::daemon::control
