// SPDX-License-Identifier: Apache-2.0
#include "experiments/drive/pose_event.hpp"

#include <cmath>
#include <numbers>

namespace deltamap::experiments {
namespace {

constexpr double kContainer_m = 2.5;
constexpr double kBlock_m = 15.0;
constexpr double kSlipLeast_m = 0.3;
constexpr double kSlipMost_m = 1.0;
constexpr double kSlipTurn_rad = radians(10.0);
constexpr int kTries = 1000;

Pose2 bay_away(const Pose2& from, const simulation::VirtualDrive& drive, Random& random) {
  for (int attempt = 0; attempt < kTries; ++attempt) {
    const double way_m = random.uniform() < 0.5 ? kContainer_m : kBlock_m;
    const double direction_rad = 0.5 * std::numbers::pi * random.index_below(4);
    const Pose2 there{from.x + way_m * std::cos(direction_rad), from.y + way_m * std::sin(direction_rad), from.theta};
    if (drive.is_on_floor(there.position())) return there;
  }
  return from;
}

Pose2 slipped(const Pose2& from, const simulation::VirtualDrive& drive, Random& random) {
  for (int attempt = 0; attempt < kTries; ++attempt) {
    const double way_m = random.uniform(kSlipLeast_m, kSlipMost_m);
    const double direction_rad = random.uniform(-std::numbers::pi, std::numbers::pi);
    const double turn_rad = random.uniform(-kSlipTurn_rad, kSlipTurn_rad);
    const Pose2 there{from.x + way_m * std::cos(direction_rad), from.y + way_m * std::sin(direction_rad),
                      wrapped_angle(from.theta + turn_rad)};
    if (drive.is_on_floor(there.position())) return there;
  }
  return from;
}

}  // namespace

std::string_view name_of(PoseEvent event) {
  switch (event) {
    case PoseEvent::kNothing:
      return "right";
    case PoseEvent::kBay:
      return "bay";
    case PoseEvent::kSlip:
      return "slipped";
    case PoseEvent::kElsewhere:
      break;
  }
  return "elsewhere";
}

void befall(simulation::VirtualDrive& drive, PoseEvent event, Random& random) {
  const Pose2 from = drive.map_from_robot();
  switch (event) {
    case PoseEvent::kNothing:
      break;
    case PoseEvent::kBay:
      drive.kidnap(bay_away(from, drive, random));
      break;
    case PoseEvent::kSlip:
      drive.kidnap(slipped(from, drive, random));
      break;
    case PoseEvent::kElsewhere:
      drive.kidnap(drive.place_anywhere(random));
      break;
  }
}

}  // namespace deltamap::experiments
