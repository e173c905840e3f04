// SPDX-License-Identifier: Apache-2.0
// `deltamap map quality MAP REC...`: is a map false? Held against the recordings that it comes from.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <deque>
#include <iostream>
#include <memory>
#include <optional>
#include <stdexcept>

#include "core/files/grid_file.hpp"
#include "daemon/settings/settings.hpp"
#include "localization/motion/odometry_buffer.hpp"
#include "simulation/score/trajectory_score.hpp"
#include "tool/map/quality_report.hpp"
#include "tool/output_file.hpp"
#include "tool/recorded_messages.hpp"
#include "tool/subcommands.hpp"

namespace deltamap::tool {
namespace {

using simulation::score::StampedPose;
using surveying::quality::PlacedScan;

constexpr double kMostBetweenS = 1.0;  // poses farther apart say nothing of a scan between them
constexpr double kKeptEachM = 0.1;
constexpr double kKeptEachRad = radians(4.0);

struct QualityOptions {
  std::string map;
  std::vector<std::string> recordings;
  std::string trajectory;
  std::string config;
  std::vector<std::string> overrides;
  std::string picture;
  bool json = false;
};

std::optional<Pose2> pose_at(const std::vector<StampedPose>& trajectory, Timestamp time) {
  constexpr double kSameS = 1e-3;
  const auto next = std::lower_bound(trajectory.begin(), trajectory.end(), time,
                                     [](const StampedPose& pose, Timestamp t) { return pose.time < t; });
  for (auto near = next == trajectory.begin() ? next : next - 1; near != trajectory.end() && near <= next; ++near) {
    if (std::abs(seconds(near->time - time)) <= kSameS) return near->map_from_robot;
  }
  if (next == trajectory.begin() || next == trajectory.end()) return std::nullopt;
  const StampedPose& before = *(next - 1);
  const double between_s = seconds(next->time - before.time);
  if (between_s > kMostBetweenS) return std::nullopt;
  return interpolated(before.map_from_robot, next->map_from_robot, seconds(time - before.time) / between_s);
}

/// Scans of all recordings at their poses, as many as tell something new.
class PlacedDrives {
 public:
  PlacedDrives(std::vector<StampedPose> trajectory, const daemon::Settings& settings)
      : trajectory_{std::move(trajectory)}, settings_{settings} {}

  void add(const std::string& recording) {
    localization::motion::OdometryBuffer odometry{settings_.localizer.odometry};
    const std::size_t before = scans_.size();
    const daemon::RecordingDecoder::Sinks sinks{[&](Odometry&& one, std::uint32_t) { odometry.add(one); },
                                                [&](Scan&& scan) { place(scan, odometry); }};
    const auto faults = read_messages(recording, settings_, sinks, "judging");
    for (const std::string& line : faults.lines()) std::cerr << "deltamap: warning: " << line << '\n';
    if (scans_.size() == before)
      throw std::runtime_error(recording + ": the trajectory has a pose for none of its scans");
    ++drive_;
  }
  [[nodiscard]] const std::vector<PlacedScan>& scans() const { return scans_; }

 private:
  void place(const Scan& scan, const localization::motion::OdometryBuffer& odometry) {
    const auto pose = pose_at(trajectory_, scan.time);
    if (!pose) return;
    if (!scans_.empty() && scans_.back().drive == drive_) {
      const Pose2 moved = motion_between(scans_.back().map_from_robot, *pose);
      if (moved.position().norm() < kKeptEachM && std::abs(moved.theta) < kKeptEachRad) return;
    }
    kept_.emplace_back(scan, odometry.velocity_at(scan.time), kept_.empty() ? nullptr : &kept_.back());
    scans_.push_back({&kept_.back(), *pose, drive_});
  }

  std::vector<StampedPose> trajectory_;
  const daemon::Settings& settings_;
  std::deque<localization::motion::PackedScan> kept_;  // which do not move
  std::vector<PlacedScan> scans_;
  std::uint32_t drive_ = 0;
};

void run_quality(const QualityOptions& options) {
  if (!options.picture.empty()) {
    for (const std::string& recording : options.recordings) require_output_beside(options.picture, recording);
    for (const std::string& file : {options.map, picture_named_in(options.map).string(), options.trajectory}) {
      require_output_beside(options.picture, file);
    }
  }
  const daemon::Settings settings = daemon::settings_or_defaults(options.config, options.overrides);
  const OccupancyGrid map = read_grid(options.map);
  PlacedDrives drives{simulation::score::read_trajectory(options.trajectory), settings};
  for (const std::string& recording : options.recordings) drives.add(recording);
  const auto quality = surveying::quality::map_quality(map, drives.scans());
  if (!options.picture.empty()) draw_quality(map, quality, options.picture);
  if (options.json) {
    std::cout << quality_as_json(quality) << '\n';
  } else {
    for (const std::string& line : quality_lines(quality)) std::cout << line << '\n';
  }
  if (quality.is_false()) throw std::runtime_error(options.map + ": the map is false");
}

}  // namespace

void add_map_quality(CLI::App& map) {
  auto options = std::make_shared<QualityOptions>();
  CLI::App& command = *map.add_subcommand("quality", "is a map false? held against the drives that it comes from");
  command.add_option("MAP", options->map, "map_server YAML")->required();
  command.add_option("REC", options->recordings, "recordings of the drives, pcapng")->required()->expected(1, -1);
  command
      .add_option("--trajectory", options->trajectory,
                  "where the scans were taken in this map (TUM): of `map build --trajectory`, or of a replay")
      ->required();
  command.add_option("--config", options->config, "settings, YAML");
  command.add_option("--set", options->overrides, "key=value over the settings; repeatable")->allow_extra_args(false);
  command.add_option("--picture", options->picture, "the map with a ring where it contradicts itself, to write (PNG)");
  command.add_flag("--json", options->json, "print the result as JSON");
  command.callback([options] { run_quality(*options); });
}

}  // namespace deltamap::tool
