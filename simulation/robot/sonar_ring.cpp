// SPDX-License-Identifier: Apache-2.0
#include "simulation/robot/sonar_ring.hpp"

#include <array>

namespace deltamap::simulation {

Pose2 robot_from_sonar(int index) {
  constexpr std::array<std::array<double, 3>, 16> kRing{{{69, 136, 90},
                                                         {114, 119, 50},
                                                         {148, 78, 30},
                                                         {166, 27, 10},
                                                         {166, -27, -10},
                                                         {148, -78, -30},
                                                         {114, -119, -50},
                                                         {69, -136, -90},
                                                         {-157, -136, -90},
                                                         {-203, -119, -130},
                                                         {-237, -78, -150},
                                                         {-255, -27, -170},
                                                         {-255, 27, 170},
                                                         {-237, 78, 150},
                                                         {-203, 119, 130},
                                                         {-157, 136, 90}}};
  const auto& [x_mm, y_mm, bearing_deg] = kRing.at(static_cast<std::size_t>(index));
  return {0.001 * x_mm, 0.001 * y_mm, radians(bearing_deg)};
}

}  // namespace deltamap::simulation
