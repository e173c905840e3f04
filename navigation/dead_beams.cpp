// SPDX-License-Identifier: Apache-2.0
#include "navigation/dead_beams.hpp"

#include <algorithm>
#include <cmath>

#include "navigation/laser_watch.hpp"
#include "navigation/mapped_walls.hpp"

namespace deltamap::navigation {
namespace {

constexpr double kPlaceM = 0.1;
constexpr double kPlaceRad = radians(3.0);
constexpr int kPlaces = 60;                 // six metres, or half a turn: farther than anything that has gone is wide
constexpr double kSectorShare = 1.0 / 6.0;  // as of a sector that breaks off at once (laser_watch)

bool is_another_place(const std::optional<Pose2>& before, const Pose2& now) {
  return !before || distance_between(*before, now) >= kPlaceM ||
         std::abs(turn_between(before->theta, now.theta)) >= kPlaceRad;
}

}  // namespace

void DeadBeams::observe(const Scan& scan) {
  const std::size_t step = beams_between(scan);
  missed_.resize((scan.beams.size() + step - 1) / step, 0);
  if (is_implausible(scan)) return;
  for (std::size_t i = 0; i < missed_.size(); ++i) {
    if (scan.beams[i * step].kind == BeamKind::kRange) missed_[i] = 0;
  }
}

void DeadBeams::hold_against_map(const TrackedScan& tracked) {
  if (is_implausible(tracked.scan)) return;
  if (tracked.estimate.state != LocalizerState::kTracking || tracked.estimate.map == nullptr) return;
  if (!is_another_place(looked_from_, tracked.estimate.map_from_robot)) return;
  looked_from_ = tracked.estimate.map_from_robot;
  const std::size_t step = beams_between(tracked.scan);
  for (std::size_t i = 0; i < missed_.size(); ++i) {
    if (tracked.scan.beams[i * step].kind != BeamKind::kRange && mapped_wall_m(tracked, i * step)) ++missed_[i];
  }
}

bool DeadBeams::hide_a_sector() const {
  const auto dead = std::count_if(missed_.begin(), missed_.end(), [](int missed) { return missed >= kPlaces; });
  return dead > 0 && static_cast<double>(dead) >= kSectorShare * static_cast<double>(missed_.size());
}

}  // namespace deltamap::navigation
