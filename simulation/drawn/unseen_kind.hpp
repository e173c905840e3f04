// SPDX-License-Identifier: Apache-2.0
// What kind of world and robot a seed stands for: every number that a tuned system may have come to rely on is drawn
// anew, independently of the others.
#pragma once

#include <cstdint>
#include <optional>

#include "drivers/lms200/variant.hpp"
#include "simulation/drawn/layout.hpp"
#include "simulation/robot/robot.hpp"
#include "simulation/virtual_drive.hpp"

namespace deltamap::simulation::drawn {

/// People who walk, and of those the ones who may stop for up to an hour.
struct People {
  int all = 0;       ///< 0 to 10
  int stopping = 0;  ///< of them
};

struct UnseenKind {
  LayoutKind layout = LayoutKind::kBlocks;
  // The map that the robot is given.
  double resolution_m = 0.05;     ///< of a cell, 0.05 or 0.1
  bool from_first_drive = false;  ///< drawn from scans at poses that are a little wrong; else exact
  double outdated_share = 0.0;    ///< of the places of things that have changed since, 0 to 0.5
  // The laser.
  drivers::lms200::ScanVariant fan;
  double range_m = 80.0;        ///< 8, 32 or 80
  double scan_period_s = 0.1;   ///< 1 to 75 scans a second, as far as the fan allows
  double range_noise_m = 0.01;  ///< 0.005 to 0.02
  Pose2 told_from_true_mount;   ///< up to 2 cm and 0.5°
  // The robot.
  double speed_m_per_s = 0.5;  ///< 0.2 to 1.2
  WheelErrors wheels;          ///< up to 2 %, 2 % and 0.3°/m
  double wheel_noise_m_per_sqrt_m = 0.002;
  double odometry_lag_s = 0.0;  ///< up to 0.15
  std::optional<SlipParams> slips;
  bool knows_start = true;
  // What happens.
  People people;
  double changes_per_min = 1.0;  ///< 0.2 to 4, of single acts
  double turns_rad = 0.0;        ///< of things that are shifted, at most
  std::optional<CreepParams> creep;
  std::optional<GapParams> gaps;
};

[[nodiscard]] UnseenKind unseen_kind(std::uint64_t seed);

}  // namespace deltamap::simulation::drawn
