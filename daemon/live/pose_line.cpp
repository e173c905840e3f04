// SPDX-License-Identifier: Apache-2.0
#include "daemon/live/pose_line.hpp"

#include <nlohmann/json.hpp>

#include "daemon/telemetry/telemetry.hpp"

namespace deltamap::daemon {
namespace {

using Json = nlohmann::ordered_json;

Json covariance_json(const PoseCovariance& c) {
  return {{"xx_m2", c(0, 0)},    {"xy_m2", c(0, 1)},    {"yy_m2", c(1, 1)},
          {"xh_m_rad", c(0, 2)}, {"yh_m_rad", c(1, 2)}, {"hh_rad2", c(2, 2)}};
}

Json hypothesis_json(const Belief& belief) {
  if (belief.other_share <= 0.0) return nullptr;
  return {{"x_m", belief.map_from_other.x},
          {"y_m", belief.map_from_other.y},
          {"heading_rad", belief.map_from_other.theta},
          {"share", belief.other_share}};
}

Json gate_json(const std::optional<mapping::gate::GateReason>& gate) {
  if (!gate) return nullptr;
  const bool is_open = *gate == mapping::gate::GateReason::kOpen;
  return {{"open", is_open}, {"reason", is_open ? Json(nullptr) : Json(name_of(*gate))}};
}

}  // namespace

std::string pose_line(const PoseNews& news) {
  const LocalizationRow& row = news.row;
  Json json;
  json["type"] = "pose";
  json["time"] = unix_seconds(row.time);
  json["scan"] = row.number;
  json["x_m"] = row.map_from_robot.x;
  json["y_m"] = row.map_from_robot.y;
  json["heading_rad"] = row.map_from_robot.theta;
  json["covariance"] = covariance_json(row.covariance);
  json["state"] = name_of(row.state);
  json["verdict"] = name_of(row.belief.verdict);
  json["pose_right"] = row.belief.pose_right;
  json["map_wrong"] = row.belief.map_wrong;
  json["speed_m_per_s"] = row.speed_m_per_s;
  json["turn_rate_rad_per_s"] = row.turn_rate_rad_per_s;
  json["revision"] = row.revision;
  json["other_hypothesis"] = hypothesis_json(row.belief);
  json["gate"] = gate_json(news.gate);
  if (news.forbidden_by) {
    json["may_drive_by_pose"] = *news.forbidden_by == navigation::StopReason::kNone;
    json["forbidden_by"] = navigation::name_of(*news.forbidden_by);
  }
  json["latency_ms"] = 1e3 * news.latency_s;
  if (news.pilot) {
    json["pilot"] = {{"speed_m_per_s", news.pilot->speed_m_per_s},
                     {"turn_rate_rad_per_s", news.pilot->turn_rate_rad_per_s}};
  }
  return json.dump();
}

}  // namespace deltamap::daemon
