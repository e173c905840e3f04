// SPDX-License-Identifier: Apache-2.0
#include "experiments/drive/view_difference.hpp"

#include <cmath>

namespace deltamap::experiments {
namespace {

constexpr int kBeams = 181;
constexpr double kOtherEnd_m = 0.25;  // between two ranges of one beam that end on different things

}  // namespace

double differing_share(const simulation::RayCaster& one, const simulation::RayCaster& other,
                       const Pose2& map_from_laser, double max_range_m) {
  int differing = 0;
  for (int beam = 0; beam < kBeams; ++beam) {
    const double bearing_rad = map_from_laser.theta + radians(beam - 90.0);
    const auto range_m = [&](const simulation::RayCaster& surfaces) {
      const auto hit = surfaces.cast(map_from_laser.position(), bearing_rad, max_range_m);
      return hit ? hit->range_m : max_range_m;
    };
    if (std::abs(range_m(one) - range_m(other)) > kOtherEnd_m) ++differing;
  }
  return static_cast<double>(differing) / kBeams;
}

}  // namespace deltamap::experiments
