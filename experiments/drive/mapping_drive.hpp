// SPDX-License-Identifier: Apache-2.0
// A simulated robot, the localizer that follows it and the mapper that follows the world, as in a replay: a revision
// reaches the localizer before the next scan. And what of all that is true.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "daemon/replay/sequential_run.hpp"
#include "daemon/settings/settings.hpp"
#include "simulation/virtual_drive.hpp"

namespace deltamap::experiments {

/// One scan of a drive.
struct Mapped {
  Pose2 map_from_robot;  ///< the truth
  Estimate estimate;
  mapping::Awareness awareness;
  std::shared_ptr<const TransientObstacles> transients;  ///< the transient layer after this scan; may be null
  TrackedScan tracked;                                   ///< what all of that was made from
  std::optional<daemon::MapStep::Result> update;         ///< what became of the Δ-phase that this scan closed
  std::vector<simulation::Change> changes;               ///< since the last scan
  std::vector<simulation::MoverEvent> events;
  int slips = 0;             ///< since the last scan
  simulation::Bodies about;  ///< who moves or stands about, and doors, now
  Timestamp time;
  double passed_s = 0.0;   ///< since the drive began
  daemon::StageCpu costs;  ///< CPU time that this scan took
};

class MappingDrive {
 public:
  /// Localizer and mapping of the settings; the robot begins where it is, whether it knows so or not.
  MappingDrive(const simulation::Scenario& scenario, const simulation::VirtualDriveParams& drive,
               const daemon::Settings& settings, const daemon::StartMap& start, bool knows_start = true);

  [[nodiscard]] Mapped next();
  /// The daemon ends and begins again where it stands: kept are the map and what of it is provisional, stability,
  /// calibration, and the pose where it is sure of that; all else is forgotten. `given`: the pose that a person gives.
  void restart(const std::optional<Pose2>& given = std::nullopt);

  [[nodiscard]] simulation::VirtualDrive& drive() { return drive_; }
  [[nodiscard]] const OccupancyGrid& map() const { return *run_->map().map(); }
  /// Of the newest scan: sure enough to judge what stands there.
  [[nodiscard]] bool pose_holds() const { return run_->store_scan().pose_holds(); }
  [[nodiscard]] const daemon::LocalizationStep& localization() const { return run_->localization(); }

 private:
  daemon::Settings settings_;
  simulation::VirtualDrive drive_;
  std::optional<daemon::SequentialRun> run_;
  std::optional<Timestamp> first_;
  Pose2 last_pose_;
};

/// Of a drive whose map stays as it is.
[[nodiscard]] daemon::Settings localizer_alone(const localization::LocalizerParams& params);

/// How far the estimate is from the truth.
struct PoseError {
  Point2 position{0.0, 0.0};  ///< estimate - truth, m, map frame
  double heading_rad = 0.0;
};
[[nodiscard]] PoseError error_of(const Mapped& scan);

}  // namespace deltamap::experiments
