// SPDX-License-Identifier: Apache-2.0
#include "mapping/paper/divergence_ratio.hpp"

namespace deltamap::mapping::paper {

double DivergenceRatio::observe(double w_avg) {
  if (!started_) {
    w_fast_ = w_slow_ = w_avg;
    started_ = true;
  }
  w_fast_ += params_.alpha_fast * (w_avg - w_fast_);
  w_slow_ += params_.alpha_slow * (w_avg - w_slow_);
  return value();
}

}  // namespace deltamap::mapping::paper
