// SPDX-License-Identifier: Apache-2.0
// Δ-awareness (paper §3.1): notices by weighted recency averaging that scans fit the map worse than they used to.
#pragma once

#include "core/messages.hpp"

namespace deltamap::mapping::paper {

struct DivergenceRatioParams {
  double alpha_slow = 0.01;  ///< long-term rate per scan, α_slow; 0 < alpha_slow < alpha_fast (Eq. 2)
  double alpha_fast = 0.1;   ///< short-term rate per scan, α_fast; alpha_fast <= 1 (Eq. 2)
};

class DivergenceRatio {
 public:
  explicit DivergenceRatio(const DivergenceRatioParams& params) : params_{params} {}

  /// Takes w_avg of every scan: w += α (w_avg - w) for both averages (Eq. 2), which start at the first. Those of a
  /// tracked pose alone count: what a lost filter thinks of a scan says nothing about the map.
  const WeightAverages& observe(const Estimate& estimate);

 private:
  DivergenceRatioParams params_;
  WeightAverages averages_;
  bool started_ = false;
};

}  // namespace deltamap::mapping::paper
