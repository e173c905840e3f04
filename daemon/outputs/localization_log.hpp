// SPDX-License-Identifier: Apache-2.0
// localization.csv of --out: a line for every scan that was localized, with what the paper's Figures 2 to 4 and 6 plot
// (w_avg, its averages of Eq. 2, r_d of Eq. 3, N_eff of Eq. 5) and what the belief in the pose rests on.
#pragma once

#include <cstdint>
#include <string>

#include "core/messages.hpp"

namespace deltamap::daemon {

/// What is plain enough to outlive the scan that it tells of.
struct LocalizationRow {
  Timestamp time;  ///< of the scan's first beam
  std::uint32_t number = 0;
  Pose2 map_from_robot;
  PoseCovariance covariance = PoseCovariance::Zero();
  LocalizerState state = LocalizerState::kGlobal;
  Belief belief;
  double w_avg = 0.0;
  double w_fast = 0.0;  ///< 0 until the first tracked scan
  double w_slow = 0.0;
  double r_d = 0.0;
  double n_eff = 0.0;
  std::uint32_t particles = 0;
  std::uint32_t revision = 0;
  double speed_m_per_s = 0.0;
  double turn_rate_rad_per_s = 0.0;

  /// A pose is tracked, and nothing says that the robot is elsewhere: the next run may begin there.
  [[nodiscard]] bool is_sure() const {
    return state == LocalizerState::kTracking && belief.verdict != PoseVerdict::kWrong && !belief.fits_worse;
  }
};

/// Averages are left at 0: whoever keeps them fills them in.
[[nodiscard]] LocalizationRow row_of(const TrackedScan& tracked);

/// The names of the columns, and one line; each with its line end. Beams are counted in the lines of those scans alone
/// that were held against the map, so that columns can be added up; 0 in the others.
[[nodiscard]] std::string csv_header();
[[nodiscard]] std::string csv_line(const LocalizationRow& row);

// What the log says when the state or the verdict changes.
[[nodiscard]] std::string state_line(const LocalizationRow& row);
[[nodiscard]] std::string verdict_line(const LocalizationRow& row);

}  // namespace deltamap::daemon
