// SPDX-License-Identifier: Apache-2.0
// A simulated robot, the localizer that follows it and the mapper that follows the world, in step as in a replay: a
// revision reaches the localizer before the next scan. And what of all that is true.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "daemon/settings/settings.hpp"
#include "daemon/steps/map_step.hpp"
#include "localization/localizer.hpp"
#include "mapping/store_scan.hpp"
#include "simulation/virtual_drive.hpp"

namespace deltamap::experiments {

/// CPU time that one scan took, s.
struct StageCosts {
  double localizer_s = 0.0;
  double awareness_s = 0.0;
  double update_s = 0.0;  ///< of the map, and of the localizer's copy
};

/// One scan of a drive.
struct Mapped {
  Pose2 map_from_robot;  ///< the truth
  Estimate estimate;
  mapping::Awareness awareness;
  std::shared_ptr<const TemporaryThings> things;  ///< the temporary layer after this scan; may be null
  TrackedScan tracked;                            ///< what all of that was made from
  std::optional<daemon::MapStep::Result> update;  ///< what became of the Δ-phase that this scan closed
  std::vector<simulation::Change> changes;        ///< since the last scan
  std::vector<simulation::MoverEvent> events;
  int slips = 0;             ///< since the last scan
  simulation::Bodies about;  ///< who moves or stands about, and doors, now
  Timestamp time;
  double passed_s = 0.0;  ///< since the drive began
  StageCosts costs;
};

class MappingDrive {
 public:
  /// Localizer and mapping of the settings.
  MappingDrive(const simulation::Scenario& scenario, const simulation::VirtualDriveParams& drive,
               const daemon::Settings& settings, std::shared_ptr<const OccupancyGrid> first_map,
               bool knows_start = true);

  [[nodiscard]] Mapped next();
  /// The daemon ends and begins again where it stands: pose, stability and map are kept, all else is forgotten.
  void restart();

  [[nodiscard]] simulation::VirtualDrive& drive() { return drive_; }
  [[nodiscard]] const OccupancyGrid& map() const { return *map_->map(); }
  [[nodiscard]] const localization::Localizer& localizer() const { return *localizer_; }

 private:
  daemon::Settings settings_;
  std::uint64_t starts_ = 0;
  simulation::VirtualDrive drive_;
  std::optional<localization::Localizer> localizer_;
  std::optional<mapping::StoreScan> store_scan_;
  std::optional<daemon::MapStep> map_;
  std::shared_ptr<const TemporaryThings> things_;
  std::optional<Timestamp> first_;
  Pose2 last_pose_;
};

}  // namespace deltamap::experiments
