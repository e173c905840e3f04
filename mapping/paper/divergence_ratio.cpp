// SPDX-License-Identifier: Apache-2.0
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
