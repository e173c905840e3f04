// SPDX-License-Identifier: Apache-2.0
#include "daemon/live/live_messages.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "daemon/dashboard/wire.hpp"
#include "daemon/live/pose_line.hpp"
#include "daemon/system/used_memory.hpp"
#include "daemon/telemetry/version.hpp"

namespace deltamap::daemon {
namespace {

using Json = nlohmann::ordered_json;
using dashboard::append_kind;
using dashboard::append_number;
using dashboard::MessageKind;

constexpr int kProtocol = 1;
constexpr double kMostSteps = 32767.0;       // largest signed 16-bit number
constexpr std::size_t kMostScans = 40;       // sent of the scans that are kept for a map update; more are thinned out
constexpr std::size_t kMostEnds = 120;       // sent of each kept scan; more beam ends are thinned out
constexpr std::size_t kMostBlocks = 20'000;  // sent of standing and of gone obstacles each; the rest is not drawn

// Names of the columns of a sample, in the order of LiveSample::Column.
constexpr const char* kSampleColumns[] = {"x_m",
                                          "y_m",
                                          "w_avg",
                                          "w_fast",
                                          "w_slow",
                                          "r_d",
                                          "n_eff",
                                          "pose_right",
                                          "map_wrong",
                                          "scans_per_s",
                                          "latency_ms",
                                          "cpu_io",
                                          "cpu_localization",
                                          "cpu_delta",
                                          "cpu_map",
                                          "cpu_recorder",
                                          "cpu_page",
                                          "memory_mib",
                                          "wheel_distance",
                                          "wheel_turn"};
static_assert(std::size(kSampleColumns) == LiveSample::kColumns);

std::string text_of(const Json& json) { return json.dump(-1, ' ', false, Json::error_handler_t::replace); }

Json blocks_json(const std::vector<std::uint32_t>& blocks) {
  const auto shown = static_cast<std::ptrdiff_t>(std::min(blocks.size(), kMostBlocks));
  return std::vector<std::uint32_t>(blocks.begin(), blocks.begin() + shown);
}

/// Appends one scan that is kept for a map update: its pose and at most kMostEnds of its beam ends, evenly thinned.
void append_stored(std::string& bytes, const TrackedScan& tracked, bool waits) {
  const std::vector<LiveBeam> beams = beams_of(tracked);
  const std::size_t every = beams.size() / kMostEnds + 1;
  append_number(bytes, static_cast<std::uint32_t>(waits));
  const Pose2& pose = tracked.estimate.map_from_robot;
  for (const double number : {pose.x, pose.y, pose.theta}) append_number(bytes, static_cast<float>(number));
  append_number(bytes, static_cast<std::uint32_t>((beams.size() + every - 1) / every));
  for (std::size_t i = 0; i < beams.size(); i += every) {
    append_number(bytes, beams[i].x_cm);
    append_number(bytes, beams[i].y_cm);
  }
}

Json list_of(const std::vector<ChangeNote>& changes) {
  Json list = Json::array();
  for (const ChangeNote& change : changes) list.push_back(Json::parse(json_line(change)));
  return list;
}

}  // namespace

std::string hello_message(const Settings& settings, const std::optional<RunName>& run) {
  const bool is_paper = settings.mapping.store_scan.method == MappingMethod::kPaper;
  const auto& gate = settings.mapping.store_scan.gate;
  Json json;
  json["type"] = "hello";
  json["protocol"] = kProtocol;
  json["version"] = version_text();
  json["method"] = is_paper ? "paper" : "evidence";
  json["thresholds"] = {{"r_d", is_paper ? Json(0.0) : Json(nullptr)},
                        {"pose_right", !is_paper && gate.enabled ? Json(gate.least_pose_right) : Json(nullptr)}};
  json["sample_columns"] = kSampleColumns;
  const DashboardSettings& page = settings.dashboard;
  json["run"] = run ? Json{{"kind", run->kind},
                           {"name", run->name},
                           {"first_revision", run->first_revision},
                           {"has_history", run->has_history}}
                    : Json(nullptr);
  const bool drives = settings.navigation.mode != navigation::DriveMode::kOff;
  json["control"] = page.control
                        ? Json{{"drive", drives && !page.token_file.empty()}, {"draw", !page.token_file.empty()}}
                        : Json(nullptr);
  return text_of(json);
}

std::string map_message(const GridGeometry& geometry, std::uint32_t revision) {
  Json json;
  json["type"] = "map";
  json["width"] = geometry.width;
  json["height"] = geometry.height;
  json["resolution_m"] = geometry.resolution_m;
  json["origin_m"] = {geometry.origin.x(), geometry.origin.y()};
  json["revision"] = revision;
  return text_of(json);
}

std::string pose_message(const LiveScan& scan, const Telemetry& telemetry, bool mapping_enabled) {
  PoseNews news{scan.row, scan.latency_s, gate_now(telemetry, mapping_enabled), {}};
  if (telemetry.drives.value() && !telemetry.by_hand.value()) {
    news.pilot = {telemetry.wanted_speed_m_per_s.value(), telemetry.wanted_turn_rate_rad_per_s.value()};
  }
  news.forbidden_by = forbidden_by(telemetry);
  return pose_line(news);
}

std::string scan_message(const LiveScan& scan) {
  std::string bytes;
  append_kind(bytes, MessageKind::kScan);
  append_number(bytes, static_cast<std::uint32_t>(scan.beams.size()));
  append_number(bytes, unix_seconds(scan.row.time));
  const Pose2& pose = scan.row.map_from_robot;
  for (const double number : {pose.x, pose.y, pose.theta}) append_number(bytes, static_cast<float>(number));
  for (const LiveBeam& beam : scan.beams) {
    append_number(bytes, beam.x_cm);
    append_number(bytes, beam.y_cm);
  }
  return bytes;
}

std::string particles_message(const LiveScan& scan) {
  const Pose2& middle = scan.row.map_from_robot;
  double reach_m = 0.0;
  for (const Pose2& pose : scan.particles) {
    reach_m = std::max({reach_m, std::abs(pose.x - middle.x), std::abs(pose.y - middle.y)});
  }
  const double step_m = std::max(0.001, reach_m / kMostSteps);
  const auto append_steps = [](std::string& bytes, double steps) {
    append_number(bytes, static_cast<std::int16_t>(std::lround(std::clamp(steps, -kMostSteps, kMostSteps))));
  };
  std::string bytes;
  append_kind(bytes, MessageKind::kParticles);
  append_number(bytes, static_cast<std::uint32_t>(scan.particles.size()));
  for (const double number : {middle.x, middle.y, step_m}) append_number(bytes, static_cast<float>(number));
  for (const Pose2& pose : scan.particles) {
    append_steps(bytes, (pose.x - middle.x) / step_m);
    append_steps(bytes, (pose.y - middle.y) / step_m);
    append_steps(bytes, pose.theta / std::numbers::pi * kMostSteps);
  }
  return bytes;
}

std::string stored_message(const mapping::StoredScans& stored) {
  const std::size_t count = stored.collected.size() + stored.waiting.size();
  const std::size_t shown = std::min(count, kMostScans);
  std::string bytes;
  append_kind(bytes, MessageKind::kStored);
  append_number(bytes, static_cast<std::uint32_t>(shown));
  for (std::size_t i = 0; i < shown; ++i) {
    const std::size_t nth = i * count / shown;
    const bool waits = nth >= stored.collected.size();
    append_stored(bytes, waits ? *stored.waiting[nth - stored.collected.size()] : *stored.collected[nth], waits);
  }
  return bytes;
}

std::string scan_json(const LiveScan& scan) {
  const Pose2& pose = scan.row.map_from_robot;
  Json json;
  json["time"] = unix_seconds(scan.row.time);
  json["pose"] = {{"x_m", pose.x}, {"y_m", pose.y}, {"heading_rad", pose.theta}};
  json["state"] = name_of(scan.row.state);
  json["verdict"] = name_of(scan.row.belief.verdict);
  json["ends_m"] = Json::array();
  for (const LiveBeam& beam : scan.beams) json["ends_m"].push_back({beam.x_cm / 100.0, beam.y_cm / 100.0});
  return text_of(json);
}

std::string transient_message(const TransientObstacles* transients) {
  Json json;
  json["type"] = "transient";
  json["standing"] = Json::array();
  json["gone"] = Json::array();
  if (transients != nullptr) {
    json["block_m"] = transients->blocks.resolution_m;
    json["origin_m"] = {transients->blocks.origin.x(), transients->blocks.origin.y()};
    json["blocks_across"] = transients->blocks.width;
    json["standing"] = blocks_json(transients->standing);
    json["gone"] = blocks_json(transients->gone);
  }
  return text_of(json);
}

std::string status_message(const std::string& status_json) {
  return "{\"type\":\"status\",\"resident_bytes\":" + std::to_string(resident_bytes()) + ",\"status\":" + status_json +
         "}";
}

std::string samples_message(const LiveBoard::Past<LiveSample>& past) {
  std::string bytes;
  append_kind(bytes, MessageKind::kSamples);
  append_number(bytes, static_cast<std::uint32_t>(past.items.size()));
  const Timestamp began = past.items.empty() ? Timestamp{} : past.items.front().time;
  append_number(bytes, unix_seconds(began));
  for (const LiveSample& sample : past.items) {
    append_number(bytes, static_cast<float>(seconds(sample.time - began)));
    for (const float value : sample.values) append_number(bytes, value);
  }
  return bytes;
}

std::string changes_message(const LiveBoard::Past<ChangeNote>& past, const LiveBoard::ChangeCounts& counts) {
  Json json;
  json["type"] = "changes";
  json["first"] = past.first;
  json["accepted"] = counts.accepted;
  json["refused"] = counts.refused;
  json["changes"] = list_of(past.items);
  return text_of(json);
}

std::string history_json(const LiveBoard& board) {
  const auto changes = board.changes_from(0, LiveBoard::kChangesKept);
  Json json;
  json["revision"] = board.map().revision;
  json["forgotten"] = changes.first;
  json["changes"] = list_of(changes.items);
  return text_of(json);
}

}  // namespace deltamap::daemon
