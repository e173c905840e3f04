// SPDX-License-Identifier: Apache-2.0
#include "simulation/movers/door.hpp"

#include <algorithm>
#include <cmath>

namespace deltamap::simulation {
namespace {

constexpr double kRoom_m = 0.15;  // between the leaf and a body

}  // namespace

std::optional<Segment> leaf_of(const DoorParams& door, double openness) {
  const Point2 along = door.closed.to - door.closed.from;
  if (door.swing_rad == 0.0) {
    if (openness >= 1.0) return std::nullopt;
    return Segment{door.closed.from, door.closed.from + (1.0 - openness) * along};
  }
  const Pose2 shut_from_now{0.0, 0.0, openness * door.swing_rad};
  return Segment{door.closed.from, door.closed.from + shut_from_now * along};
}

Door::Door(const DoorParams& params, Random random) : params_{params}, random_{random} {
  opening_ = random_.uniform() < params_.open_share;
  openness_ = opening_ ? 1.0 : 0.0;
  phase_left_s_ = random_.uniform() * phase_s();
}

/// A phase lasts from half to one and a half of its mean.
double Door::phase_s() {
  const double share = opening_ ? params_.open_share : 1.0 - params_.open_share;
  return params_.period_s * share * random_.uniform(0.5, 1.5);
}

void Door::move(double dt_s, std::span<const Circle> robot_and_walkers) {
  phase_left_s_ -= dt_s;
  if (phase_left_s_ <= 0.0) {
    const bool is_for_ever = opening_ ? params_.open_share >= 1.0 : params_.open_share <= 0.0;
    if (!is_for_ever) opening_ = !opening_;
    phase_left_s_ = phase_s();
  }
  const double wanted = opening_ ? 1.0 : 0.0;
  if (openness_ == wanted) return;
  const double step = dt_s / params_.moving_s;
  const double next = std::clamp(openness_ + (opening_ ? step : -step), 0.0, 1.0);
  if (!would_hit(next, robot_and_walkers)) openness_ = next;
}

bool Door::would_hit(double openness, std::span<const Circle> bodies) const {
  const auto after = leaf_of(params_, openness);
  if (!after) return false;
  const auto before = leaf();
  return std::any_of(bodies.begin(), bodies.end(), [&](const Circle& body) {
    const double after_m = distance_between(body.centre, *after);
    const bool nearer = !before || after_m < distance_between(body.centre, *before);
    return nearer && after_m < body.radius_m + kRoom_m;
  });
}

}  // namespace deltamap::simulation
