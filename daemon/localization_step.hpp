// SPDX-License-Identifier: Apache-2.0
// What the localization thread does with each message, and what a replay does in its place: odometry, revisions and
// scans to the localizer, a trajectory point for every scan.
#pragma once

#include <deque>
#include <memory>
#include <optional>

#include "core/messages.hpp"
#include "daemon/outputs.hpp"
#include "daemon/settings.hpp"
#include "localization/localizer.hpp"

namespace deltamap::daemon {

/// The map that a run starts on: M_0, or the newest revision of the store.
struct StartMap {
  std::shared_ptr<const OccupancyGrid> map;
  std::uint32_t revision = 0;
};

class LocalizationStep {
 public:
  /// Throws std::runtime_error where the map has no free cell.
  LocalizationStep(const Settings& settings, const StartMap& start);

  void observe(const Odometry& odometry);
  [[nodiscard]] TrackedScan observe(Scan scan);
  /// A scan that a newer one has overtaken: where odometry alone says that it was taken.
  [[nodiscard]] TrajectoryPoint pass_over(const Scan& scan);
  void apply(const MapRevision& revision);

  [[nodiscard]] double time_lost_s() const { return time_lost_s_; }
  [[nodiscard]] double time_global_s() const { return time_global_s_; }
  /// From the first scan to the last.
  [[nodiscard]] double covered_s() const;

 private:
  [[nodiscard]] std::optional<Odometry> odometry_at(Timestamp time) const;
  void count_time(Timestamp time);

  localization::Localizer localizer_;
  std::deque<Odometry> recent_odometry_;
  Pose2 last_map_from_robot_;
  Pose2 last_odom_from_robot_;
  std::optional<std::uint32_t> last_epoch_;
  LocalizerState last_state_ = LocalizerState::kGlobal;
  std::optional<Timestamp> first_scan_;
  std::optional<Timestamp> last_scan_;
  double time_lost_s_ = 0.0;
  double time_global_s_ = 0.0;
};

}  // namespace deltamap::daemon
