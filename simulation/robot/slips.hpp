// SPDX-License-Identifier: Apache-2.0
// Wheels that slip while the robot drives: now and then they count a way, or a turn, that the body does not make. It
// lasts for a moment, as a slip does, and does not jump from one report to the next.
#pragma once

#include "core/geometry/pose2.hpp"
#include "core/random.hpp"

namespace deltamap::simulation {

struct SlipParams {
  double every_m = 30.0;   ///< mean way between two slips, > 0
  double length_m = 0.3;   ///< of a straight slip, too much or too little by chance, >= 0
  double turn_rad = 0.15;  ///< of a turning slip, to either side by chance, >= 0
  double lasts_s = 0.5;    ///< > 0
};

class Slips {
 public:
  Slips(const SlipParams& params, Random random);

  /// What the wheels count besides while they drive so far in so long, robot frame.
  [[nodiscard]] Pose2 observe(double driven_m, double dt_s);
  /// So far.
  [[nodiscard]] int begun() const { return begun_; }

 private:
  SlipParams params_;
  Random random_;
  double left_m_ = 0.0;  // until the next one begins
  double left_s_ = 0.0;  // of the present one
  double speed_m_per_s_ = 0.0;
  double turn_rate_rad_per_s_ = 0.0;
  int begun_ = 0;
};

}  // namespace deltamap::simulation
