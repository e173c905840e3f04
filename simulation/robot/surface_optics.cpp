// SPDX-License-Identifier: Apache-2.0
#include "simulation/robot/surface_optics.hpp"

#include <array>
#include <utility>

namespace deltamap::simulation {

WrapEcho wrap_echo(const SurfaceOptics& optics, double fate) {
  const std::array<std::pair<WrapEcho, double>, 4> others{{{WrapEcho::kNone, optics.wrap_no_return_share},
                                                           {WrapEcho::kThrough, optics.wrap_through_share},
                                                           {WrapEcho::kDazzled, optics.wrap_dazzle_share},
                                                           {WrapEcho::kShort, optics.wrap_short_share}}};
  for (const auto& [echo, share] : others) {
    if (fate < share) return echo;
    fate -= share;
  }
  return WrapEcho::kReturned;
}

}  // namespace deltamap::simulation
