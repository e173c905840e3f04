// SPDX-License-Identifier: Apache-2.0
// What the localization thread decides about driving after each scan: whether the pose is good enough to drive by,
// where the pilot wants to go, and whether the laser should see anything at all. The io thread has the last word
// (DriveDesk).
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "core/messages.hpp"
#include "core/transient_obstacles.hpp"
#include "core/zones.hpp"
#include "daemon/settings/settings.hpp"
#include "navigation/dead_beams.hpp"
#include "navigation/pose_watch.hpp"
#include "navigation/stop_reason.hpp"
#include "navigation/wander.hpp"
#include "navigation/zoned_driving.hpp"

namespace deltamap::daemon {

struct PilotWord {
  DriveCommand command;
  navigation::StopReason held_by = navigation::StopReason::kNone;  ///< why the pilot itself does not drive now
  navigation::StopReason pose = navigation::StopReason::kNone;     ///< why nobody should drive by this pose
  bool wheels_spin = false;                                        ///< they turn, and the scans stand
  bool misses_walls = false;                                       ///< a part of the laser never sees what the map has
  bool expects_no_range = false;    ///< the map has nothing within reach of the beams without a range
  navigation::ZonesAround zones{};  ///< that whoever drives has to heed; nothing while the pose does not hold
};

class PilotStep {
 public:
  explicit PilotStep(const Settings& settings, Zones zones = {});

  /// What is known of a scan besides its pose.
  struct Seen {
    std::optional<double> fit;                       ///< as LocalizationStep::fit()
    bool start_fits = true;                          ///< as FitWatch::start_fits()
    const TransientObstacles* transients = nullptr;  ///< what differs from the map now; null: not known
    std::uint32_t times_let_drive = 0;               ///< as Safety::times_let_drive()
  };
  [[nodiscard]] PilotWord observe(const TrackedScan& tracked, const Seen& seen);
  /// In the middle of a run: from the next scan on.
  void set_params(const navigation::WanderParams& params);
  void set_zones(Zones zones) { zones_ = std::move(zones); }

 private:
  /// What stands there although the scan does not show it.
  [[nodiscard]] std::vector<Point2> obstacles_beside(const TrackedScan& tracked, const Seen& seen,
                                                     const navigation::ZonesAround& zones) const;

  bool drives_without_pose_;
  Zones zones_;
  navigation::PoseWatch pose_watch_;
  navigation::DeadBeams dead_beams_;
  std::uint32_t times_let_drive_ = 0;
  std::optional<navigation::Wander> wander_;  // nothing: nobody drives in this run
};

}  // namespace deltamap::daemon
