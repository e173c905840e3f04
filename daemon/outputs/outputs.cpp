// SPDX-License-Identifier: Apache-2.0
#include "daemon/outputs/outputs.hpp"

#include <unistd.h>

#include <cinttypes>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "core/files/grid_file.hpp"
#include "core/files/replace_file.hpp"
#include "daemon/settings/provenance.hpp"

namespace deltamap::daemon {
namespace {

using Json = nlohmann::ordered_json;

double milliseconds(double seconds) { return seconds * 1e3; }

Json as_json(const drivers::port::LogFaults& faults) {
  Json json{{"cut", faults.cut.has_value()}};
  if (const auto& cut = faults.cut) {
    json["byte"] = cut->byte;
    json["unread_bytes"] = cut->unread_bytes;
    json["last_record_time"] = cut->last_record ? Json(unix_seconds(*cut->last_record)) : Json(nullptr);
    json["warning"] = cut->text;
  }
  json["doubts"] = faults.doubts;
  return json;
}

void add_scans(Json& json, const ScanCounts& scans) {
  json["scans"] = scans.decoded;
  json["localized"] = scans.localized;
  json["odometry"] = scans.odometry;
  for (const auto& [name, count] : drops_of(scans)) json["drops"][name] = count;
}

void add_changes(Json& json, const RunReport& report) {
  json["delta_phases"] = report.phases;
  Json revisions = Json::array();
  for (const ChangeTally::Revision& revision : report.changes.revisions()) {
    revisions.push_back({{"number", revision.number},
                         {"time", unix_seconds(revision.time)},
                         {"phase", revision.phase},
                         {"added", revision.added},
                         {"freed", revision.freed},
                         {"forgotten", revision.forgotten}});
  }
  json["revisions"] = revisions;
  json["revisions_total"] = report.changes.accepted();
  json["refusals"] = report.changes.refusals().empty() ? Json::object() : Json(report.changes.refusals());
}

/// What the localizer took its pose to be, and what mapping made of it.
void add_belief(Json& json, const RunReport& report) {
  json["time_lost_s"] = report.time_lost_s;
  json["time_global_s"] = report.time_global_s;
  json["pose_verdict"] = {{"right_s", report.verdict_times.right_s},
                          {"undecided_s", report.verdict_times.undecided_s},
                          {"wrong_s", report.verdict_times.wrong_s}};
  json["write_gate"] = {{"observed_s", mapping::gate::observed_s(report.gate_times)},
                        {"shut_s", mapping::gate::shut_s(report.gate_times)},
                        {"shut_by_reason_s", mapping::gate::shut_by_reason(report.gate_times)}};
  json["localizer"] = report.localizer;
}

/// Time and memory.
void add_cost(Json& json, const RunReport& report) {
  const double per_scan = report.cpu_total_s / static_cast<double>(std::max<std::uint64_t>(report.scans.decoded, 1));
  json["cpu"] = {{"total_s", report.cpu_total_s},         {"per_scan_ms", milliseconds(per_scan)},
                 {"decoding_s", report.cpu.decoding_s},   {"localization_s", report.cpu.localization_s},
                 {"awareness_s", report.cpu.awareness_s}, {"map_update_s", report.cpu.map_update_s},
                 {"recording_s", report.cpu.recording_s}};
  json["wall_s"] = report.wall_s;
  json["peak_resident_bytes"] = report.peak_resident_bytes;
  json["latency_ms"] = {{"of", report.latency_of},
                        {"p50", milliseconds(report.latency.quantile_s(0.5))},
                        {"p99", milliseconds(report.latency.quantile_s(0.99))},
                        {"p999", milliseconds(report.latency.quantile_s(0.999))},
                        {"max", milliseconds(report.latency.max_s())}};
}

void add_replay(Json& json, const RunReport& report) {
  json["journal"] = {
      {"state", report.journal}, {"differences", report.journal_differences}, {"commands", report.commands}};
  json["began"] = report.began;
  json["recording"] = as_json(report.recording);
  json["recording"]["file"] = report.recording_file;
  json["recording"]["outside_window"] = {{"packets_before", report.outside_window.packets_before},
                                         {"scans_before", report.outside_window.scans_before},
                                         {"packets_after", report.outside_window.packets_after}};
}

}  // namespace

std::string tum_line(const TrajectoryPoint& point) {
  const Pose2& pose = point.map_from_robot;
  const std::int64_t ns = unix_ns(point.time);
  char line[192];
  const int length =
      std::snprintf(line, sizeof line, "%" PRId64 ".%09" PRId64 " %.6f %.6f 0 0 0 %.9f %.9f\n", ns / 1'000'000'000,
                    ns % 1'000'000'000, pose.x, pose.y, std::sin(pose.theta / 2.0), std::cos(pose.theta / 2.0));
  return {line, static_cast<std::size_t>(length)};
}

std::string json_text(const RunReport& report, const Settings& settings) {
  Json json;
  add_provenance(json, settings);
  add_scans(json, report.scans);
  add_changes(json, report);
  add_belief(json, report);
  json["recorded_s"] = report.recorded_s;
  add_cost(json, report);
  if (!report.journal.empty()) add_replay(json, report);
  json["wire"] = report.wire;
  return json.dump(2) + "\n";
}

void require_map_elsewhere(const std::filesystem::path& map, const std::filesystem::path& out) {
  for (const auto& mine : {map, picture_named_in(map)}) {
    for (const char* name : {"map.yaml", "map.pgm"}) {
      std::error_code ignored;
      if (!std::filesystem::equivalent(mine, out / name, ignored)) continue;
      throw std::runtime_error(mine.string() + ": --out would overwrite it; give another folder");
    }
  }
}

void require_no_other_maps(const std::filesystem::path& out, const std::filesystem::path& own_store) {
  require_lockable_file(out / "map.pgm");
  const auto history = out / "map_store.sqlite";
  std::error_code ignored;
  const bool is_own = !own_store.empty() && std::filesystem::equivalent(history, own_store, ignored);
  if (is_own || !std::filesystem::exists(history, ignored)) return;
  require_lockable_file(history);
  if (std::filesystem::exists(out / "changes.jsonl", ignored)) return;
  throw std::runtime_error(history.string() +
                           ": --out would replace it, and no run with --out has left it; give another folder");
}

StagingFolder::StagingFolder(const std::filesystem::path& target)
    : target_{std::filesystem::absolute(target).lexically_normal()} {
  if (!target_.has_filename()) target_ = target_.parent_path();
  std::error_code error;
  if (std::filesystem::exists(target_) && !std::filesystem::is_directory(target_)) {
    throw std::runtime_error(target_.string() + ": is no folder");
  }
  if (std::filesystem::exists(target_)) {
    lock_ = lock_of_folder(target_);
    require_no_other_maps(target_);
  }
  staging_ = target_.parent_path() / ("." + target_.filename().string() + "." + std::to_string(::getpid()));
  std::filesystem::create_directories(staging_, error);
  if (error) throw std::runtime_error(staging_.string() + ": cannot create: " + error.message());
}

StagingFolder::~StagingFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(staging_, ignored);
}

void StagingFolder::commit() {
  std::filesystem::create_directories(target_);
  if (!lock_) lock_ = lock_of_folder(target_);
  require_no_other_maps(target_);
  for (const auto& entry : std::filesystem::directory_iterator(staging_)) {
    move_into_place(entry.path(), target_ / entry.path().filename());
  }
}

}  // namespace deltamap::daemon
