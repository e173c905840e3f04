// SPDX-License-Identifier: Apache-2.0
#include "simulation/robot/slips.hpp"

#include <algorithm>
#include <cmath>

namespace deltamap::simulation {
namespace {

double way_to_next_m(double mean_m, Random& random) { return -mean_m * std::log(1.0 - random.uniform()); }

}  // namespace

Slips::Slips(const SlipParams& params, Random random)
    : params_{params}, random_{random}, left_m_{way_to_next_m(params.every_m, random_)} {}

Pose2 Slips::observe(double driven_m, double dt_s) {
  if (left_s_ <= 0.0) {
    left_m_ -= driven_m;
    if (left_m_ > 0.0) return {};
    left_m_ = way_to_next_m(params_.every_m, random_);
    left_s_ = params_.lasts_s;
    const double sign = random_.uniform() < 0.5 ? -1.0 : 1.0;
    const bool turns = random_.uniform() < 0.5;
    speed_m_per_s_ = turns ? 0.0 : sign * params_.length_m / params_.lasts_s;
    turn_rate_rad_per_s_ = turns ? sign * params_.turn_rad / params_.lasts_s : 0.0;
    ++begun_;
  }
  const double slipping_s = std::min(dt_s, left_s_);
  left_s_ -= slipping_s;
  return {speed_m_per_s_ * slipping_s, 0.0, turn_rate_rad_per_s_ * slipping_s};
}

}  // namespace deltamap::simulation
