// SPDX-License-Identifier: Apache-2.0
// Notices that scans suddenly fit a little worse than over the last seconds. Something in view has changed, or the
// robot has been carried to a place that looks much the same: time to look through the whole map, no more.
#pragma once

#include <algorithm>
#include <cmath>

namespace deltamap::localization {

struct FitFallParams {
  double usual_s = 10.0;    ///< over which the usual share of explained ends is averaged, s; > 0
  double present_s = 0.35;  ///< over which the present one is, s; > 0
  double least = 0.02;      ///< of the share that is a fall; 0..1; and besides
  double deviations = 1.0;  ///< so many times its usual deviation: real logs waver; >= 0
  double recent_s = 5.0;    ///< so long it is heeded, s; >= 0
};

class FitFall {
 public:
  explicit FitFall(const FitFallParams& params = {}) : params_{params} {}

  /// `fit`: share of the ends that the map explains at the believed pose (explained_share).
  void observe(double fit, double passed_s) {
    if (!any_) usual_ = present_ = fit;
    any_ = true;
    const double deviation = std::abs(fit - usual_);
    usual_ += std::min(1.0, passed_s / params_.usual_s) * (fit - usual_);
    present_ += std::min(1.0, passed_s / params_.present_s) * (fit - present_);
    const bool falls = usual_ - present_ > params_.least + params_.deviations * deviation_;
    deviation_ += std::min(1.0, passed_s / params_.usual_s) * (deviation - deviation_);
    left_s_ = falls ? params_.recent_s : std::max(0.0, left_s_ - passed_s);
  }
  [[nodiscard]] bool is_recent() const { return left_s_ > 0.0; }

 private:
  FitFallParams params_;
  bool any_ = false;
  double usual_ = 0.0;
  double present_ = 0.0;
  double deviation_ = 0.0;
  double left_s_ = 0.0;
};

}  // namespace deltamap::localization
