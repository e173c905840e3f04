// SPDX-License-Identifier: Apache-2.0
#include "localization/hypotheses/outlier_rate.hpp"

#include <algorithm>
#include <cmath>

namespace deltamap::localization::hypotheses {
namespace {

constexpr double kMemorySteps = 120.0;  // some 24 m: what is usual in the hall, not in the corner in view
constexpr double kFirstSteps = 3.0;     // for so many it counts at first that few miss

}  // namespace

void OutlierRate::observe(double outliers) {
  scans_ += 1.0;
  share_ += (outliers - share_) / std::min(kMemorySteps, kFirstSteps + scans_);
}

double OutlierRate::evidence_weight() const {
  const double outliers = std::clamp(share_, kRare, 0.5);
  return std::log((1.0 - outliers) / outliers) / std::log((1.0 - kRare) / kRare);
}

}  // namespace deltamap::localization::hypotheses
