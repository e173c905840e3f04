// SPDX-License-Identifier: Apache-2.0
#include "localization/belief/carried_pose.hpp"

namespace deltamap::localization::belief {
namespace {

// Wheels and scans together err by 0.1 to 0.3 m over such a way (docs/decisions/laser-odometer.md).
constexpr double kFarthestM = 20.0;

}  // namespace

void CarriedPose::observe(const Step& step) {
  if (!since_m_) return;
  if (!step.is_continued || !step.fits_before) return end();
  *since_m_ += step.driven_m;
}

bool CarriedPose::is_carried() const { return since_m_ && *since_m_ <= kFarthestM; }

}  // namespace deltamap::localization::belief
