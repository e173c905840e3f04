// SPDX-License-Identifier: Apache-2.0
// A simulated robot and the localizer that follows it, in step; and what of the estimate is true.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "localization/localizer.hpp"
#include "localization/localizer_params.hpp"
#include "simulation/virtual_drive.hpp"

namespace deltamap::experiments {

/// One scan of a drive.
struct Followed {
  Pose2 map_from_robot;  ///< the truth
  Estimate estimate;
  std::vector<simulation::Change> changes;  ///< since the last scan
  double passed_s = 0.0;                    ///< since the drive began
};

class LocalizerDrive {
 public:
  LocalizerDrive(const simulation::Scenario& scenario, const simulation::VirtualDriveParams& drive,
                 const localization::LocalizerParams& localizer, std::shared_ptr<const OccupancyGrid> map,
                 std::optional<localization::InitialPose> initial_pose);

  [[nodiscard]] Followed next();
  /// The last scan as the localizer handed it on.
  [[nodiscard]] const TrackedScan& tracked() const { return tracked_; }
  [[nodiscard]] simulation::VirtualDrive& drive() { return drive_; }
  [[nodiscard]] localization::Localizer& localizer() { return localizer_; }

 private:
  simulation::VirtualDrive drive_;
  localization::Localizer localizer_;
  std::optional<Timestamp> first_;
  TrackedScan tracked_;
};

/// M_0 of a scenario as the experiments use it, 0.05 m a cell.
[[nodiscard]] std::shared_ptr<const OccupancyGrid> first_map(const simulation::Scenario& scenario);

/// How far the estimate is from the truth.
struct PoseError {
  Point2 position{0.0, 0.0};  ///< estimate - truth, m, map frame
  double heading_rad = 0.0;
};
[[nodiscard]] PoseError error_of(const Followed& scan);

}  // namespace deltamap::experiments
