// SPDX-License-Identifier: Apache-2.0
#include "simulation/range_finder.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace deltamap::simulation {

std::vector<Reading> RangeFinder::measure(const Sweep& sweep, double max_range_m, const RayCaster& world,
                                          const RobotAt& map_from_robot_at, const PeopleAt& people_at) {
  assert(sweep.bearings_rad.size() == sweep.offsets_s.size() && "every beam has a bearing and a time");
  std::vector<Reading> readings;
  readings.reserve(sweep.bearings_rad.size());
  for (std::size_t beam = 0; beam < sweep.bearings_rad.size(); ++beam) {
    const double offset_s = sweep.offsets_s[beam];
    const Pose2 map_from_laser = map_from_robot_at(offset_s) * params_.robot_from_laser;
    readings.push_back(measure_beam(map_from_laser, sweep.bearings_rad[beam], max_range_m, world, people_at(offset_s)));
  }
  return readings;
}

Reading RangeFinder::measure_beam(const Pose2& map_from_laser, double bearing_rad, double max_range_m,
                                  const RayCaster& world, std::span<const Circle> people) {
  // Both numbers are drawn for every beam, so that one beam's fate does not shift the chances of all that follow.
  const double fate = random_.uniform();
  const double noise_m = random_.normal(params_.range_noise_m);
  if (fate < params_.dropout_share) return {BeamKind::kNotValid, 0.0};
  if (fate < params_.dropout_share + params_.dazzle_share) return {BeamKind::kDazzled, 0.0};

  const Point2 origin = map_from_laser.position();
  const auto range_towards = [&](double bearing_in_map) {
    const auto hit = world.cast(origin, bearing_in_map, 2.0 * max_range_m, people);
    return hit ? hit->range_m : 2.0 * max_range_m;
  };
  // The cone's rims tell whether an edge splits the beam; then the light of both depths may blend to one between.
  const double bearing_in_map = map_from_laser.theta + bearing_rad;
  const double right_m = range_towards(bearing_in_map - 0.5 * params_.footprint_rad);
  const double left_m = range_towards(bearing_in_map + 0.5 * params_.footprint_rad);
  double range_m = range_towards(bearing_in_map);
  if (std::abs(left_m - right_m) > params_.mixed_step_m + 0.02 * std::min(left_m, right_m)) {
    const double share = random_.uniform();
    if (random_.uniform() < params_.mixed_share) range_m = right_m + share * (left_m - right_m);
  }
  range_m += params_.range_bias_m + noise_m;
  if (range_m > max_range_m) return {BeamKind::kBeyondMaximum, 0.0};
  return {BeamKind::kRange, std::max(0.0, range_m)};
}

}  // namespace deltamap::simulation
