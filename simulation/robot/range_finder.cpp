// SPDX-License-Identifier: Apache-2.0
#include "simulation/robot/range_finder.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace deltamap::simulation {

std::vector<Reading> RangeFinder::measure(const Sweep& sweep, double max_range_m, const RayCaster& world,
                                          const RobotAt& map_from_robot_at, const MovingAt& moving_at) {
  assert(sweep.bearings_rad.size() == sweep.offsets_s.size() && "every beam has a bearing and a time");
  std::vector<Reading> readings;
  readings.reserve(sweep.bearings_rad.size());
  for (std::size_t beam = 0; beam < sweep.bearings_rad.size(); ++beam) {
    const double offset_s = sweep.offsets_s[beam];
    const Pose2 map_from_laser = map_from_robot_at(offset_s) * params_.robot_from_laser;
    readings.push_back(measure_beam(map_from_laser, sweep.bearings_rad[beam], max_range_m, world, moving_at(offset_s)));
  }
  return readings;
}

/// Half of the cone's light is enough for an echo: what is thin and stands in the cone's inner half is read, though its
/// middle may pass beside it.
template <typename HitTowards>
std::optional<RayHit> RangeFinder::nearest_thin(double bearing_in_map, std::optional<RayHit> middle,
                                                const HitTowards& hit_towards) const {
  std::optional<RayHit> nearest = middle;
  for (const double off_share : {-0.25, 0.25}) {
    const auto hit = hit_towards(bearing_in_map + off_share * params_.footprint_rad);
    if (hit && hit->is_thin && (!nearest || hit->range_m < nearest->range_m)) nearest = hit;
  }
  return nearest;
}

Reading RangeFinder::measure_beam(const Pose2& map_from_laser, double bearing_rad, double max_range_m,
                                  const RayCaster& world, const MovingSurfaces& moving) {
  // Both numbers are drawn for every beam, so that one beam's fate does not shift the chances of all that follow.
  const double fate = random_.uniform();
  const double noise_m = random_.normal(params_.range_noise_m);
  if (fate < params_.dropout_share) return {BeamKind::kNotValid, 0.0};
  if (fate < params_.dropout_share + params_.dazzle_share) return {BeamKind::kDazzled, 0.0};

  const Point2 origin = map_from_laser.position();
  std::optional<WrapEcho> wrap;  // one for the whole beam, drawn where it meets any
  const auto passes = [&](const RayHit& hit) {
    if (hit.material == Material::kGlass) return passes_glass(hit, params_.surfaces);
    if (!wrap) wrap = wrap_echo(params_.surfaces, random_.uniform());
    return *wrap == WrapEcho::kThrough;
  };
  const auto hit_towards = [&](double bearing_in_map) {
    return cast_through(world, origin, bearing_in_map, 2.0 * max_range_m, moving, passes);
  };
  const auto range_of = [&](const std::optional<RayHit>& hit) { return hit ? hit->range_m : 2.0 * max_range_m; };
  // The cone's rims tell whether an edge splits the beam; then the light of both depths may blend to one between.
  const double bearing_in_map = map_from_laser.theta + bearing_rad;
  const double right_m = range_of(hit_towards(bearing_in_map - 0.5 * params_.footprint_rad));
  const double left_m = range_of(hit_towards(bearing_in_map + 0.5 * params_.footprint_rad));
  std::optional<RayHit> middle = hit_towards(bearing_in_map);
  if (world.has_thin_objects()) middle = nearest_thin(bearing_in_map, middle, hit_towards);
  double range_m = range_of(middle);
  if (middle && middle->material == Material::kWrap) {
    if (*wrap == WrapEcho::kNone) return {BeamKind::kNotValid, 0.0};
    if (*wrap == WrapEcho::kDazzled) return {BeamKind::kDazzled, 0.0};
    if (*wrap == WrapEcho::kShort) range_m -= params_.surfaces.wrap_short_m * random_.uniform();
  }
  if (std::abs(left_m - right_m) > params_.mixed_step_m + 0.02 * std::min(left_m, right_m)) {
    const double share = random_.uniform();
    if (random_.uniform() < params_.mixed_share) range_m = right_m + share * (left_m - right_m);
  }
  range_m += params_.range_bias_m + noise_m;
  if (range_m > max_range_m) return {BeamKind::kBeyondMaximum, 0.0};
  return {BeamKind::kRange, std::max(0.0, range_m)};
}

}  // namespace deltamap::simulation
