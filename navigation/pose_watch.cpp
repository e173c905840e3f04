// SPDX-License-Identifier: Apache-2.0
#include "navigation/pose_watch.hpp"

#include <algorithm>
#include <cmath>

#include "core/geometry/pose_spread.hpp"

namespace deltamap::navigation {
namespace {

constexpr double kUnsureM = 1.0;
// At a right pose four beams in five fit, where much has changed one in three for seconds (belief/fit_monitor.hpp).
constexpr double kLeastFit = 0.2;
constexpr double kMemoryS = 1.0;  // time constant of the mean fit: from a good one to none it takes two seconds

}  // namespace

bool PoseWatch::is_unfit(const PoseNow& pose) {
  const Timestamp now = pose.estimate.time;
  const double passed_s = last_ ? std::max(0.0, seconds(now - *last_)) : 0.0;
  last_ = now;
  const bool speaks_against = pose.estimate.belief.is_carried && pose.fit && *pose.fit < mean_fit_;
  if (pose.fit && !speaks_against) mean_fit_ += (1.0 - std::exp(-passed_s / kMemoryS)) * (*pose.fit - mean_fit_);
  return mean_fit_ < kLeastFit;
}

StopReason PoseWatch::observe(const PoseNow& pose) {
  const bool unfit = is_unfit(pose);
  if (pose.estimate.state == LocalizerState::kGlobal) return StopReason::kPoseUnknown;
  if (pose.estimate.state == LocalizerState::kLost) return StopReason::kLost;
  if (pose.estimate.belief.verdict == PoseVerdict::kWrong) return StopReason::kPoseWrong;
  if (!pose.start_fits) return StopReason::kStartUnfit;
  if (widest_deviation_m(pose.estimate.covariance) > kUnsureM) return StopReason::kPoseUnsure;
  return unfit ? StopReason::kPoseUnfit : StopReason::kNone;
}

}  // namespace deltamap::navigation
