// SPDX-License-Identifier: Apache-2.0
// Δ-awareness (paper §3.1): notices by weighted recency averaging that scans fit the map worse than they used to.
#pragma once

namespace deltamap::mapping::paper {

struct DivergenceRatioParams {
  double alpha_slow = 0.01;  ///< long-term rate per scan, α_slow; 0 < alpha_slow < alpha_fast (Eq. 2)
  double alpha_fast = 0.1;   ///< short-term rate per scan, α_fast; alpha_fast <= 1 (Eq. 2)
};

class DivergenceRatio {
 public:
  explicit DivergenceRatio(const DivergenceRatioParams& params) : params_{params} {}

  /// Takes w_avg, the weight of the best pose hypothesis, and returns r_d = 1 - w_fast / w_slow (Eq. 3). Positive:
  /// scans fit the map worse than they used to. w += α (w_avg - w) for both averages (Eq. 2), which start at the first
  /// w_avg.
  double observe(double w_avg);

  [[nodiscard]] double w_fast() const { return w_fast_; }
  [[nodiscard]] double w_slow() const { return w_slow_; }
  [[nodiscard]] double value() const { return w_slow_ > 0.0 ? 1.0 - w_fast_ / w_slow_ : 0.0; }

 private:
  DivergenceRatioParams params_;
  double w_fast_ = 0.0;
  double w_slow_ = 0.0;
  bool started_ = false;
};

}  // namespace deltamap::mapping::paper
