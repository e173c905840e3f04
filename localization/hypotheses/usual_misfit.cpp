// SPDX-License-Identifier: Apache-2.0
#include "localization/hypotheses/usual_misfit.hpp"

#include <algorithm>
#include <cmath>

namespace deltamap::localization::hypotheses {
namespace {

constexpr double kMemorySteps = 120.0;  // some 24 m: what is usual in the hall, not in the corner in view
constexpr double kFirstSteps = 3.0;     // for so many it counts at first that few miss

}  // namespace

void UsualMisfit::observe(double misfit) {
  scans_ += 1.0;
  share_ += (misfit - share_) / std::min(kMemorySteps, kFirstSteps + scans_);
}

double UsualMisfit::telling() const {
  const double misfit = std::clamp(share_, kRare, 0.5);
  return std::log((1.0 - misfit) / misfit) / std::log((1.0 - kRare) / kRare);
}

}  // namespace deltamap::localization::hypotheses
