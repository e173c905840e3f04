// SPDX-License-Identifier: Apache-2.0
// Why two averages: how well scans fit depends on building and laser, so no fixed threshold of w_avg tells a change.
// The slow average is what is usual here, and the fast one is compared with it (as in the augmented filter of Thrun,
// Burgard and Fox, "Probabilistic Robotics", 2005, Table 8.3).
#include "mapping/paper/divergence_ratio.hpp"

namespace deltamap::mapping::paper {

const WeightAverages& DivergenceRatio::observe(const Estimate& estimate) {
  if (estimate.state != LocalizerState::kTracking) return averages_;
  if (!started_) {
    averages_ = {.w_fast = estimate.w_avg, .w_slow = estimate.w_avg};
    started_ = true;
  }
  averages_.w_fast += params_.alpha_fast * (estimate.w_avg - averages_.w_fast);
  averages_.w_slow += params_.alpha_slow * (estimate.w_avg - averages_.w_slow);
  return averages_;
}

}  // namespace deltamap::mapping::paper
