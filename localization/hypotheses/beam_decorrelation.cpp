// SPDX-License-Identifier: Apache-2.0
#include "localization/hypotheses/beam_decorrelation.hpp"

#include <algorithm>
#include <limits>

namespace deltamap::localization::hypotheses {
namespace {

constexpr double kPatchM = 0.5;
constexpr int kAcrossBits = 8;
constexpr std::int32_t kAcross = 1 << kAcrossBits;   // patches of the torus: 128 m
constexpr std::uint32_t kForgottenAfterScans = 150;  // odometry has drifted by a patch since

constexpr float kMostOfAScan = 0.25F;  // of its beams together: one view may look like another

std::size_t wrapped(std::int32_t at) { return static_cast<std::size_t>(at & (kAcross - 1)); }

}  // namespace

BeamDecorrelation::BeamDecorrelation() : patches_(static_cast<std::size_t>(kAcross) * kAcross) {}

void BeamDecorrelation::clear() { std::fill(patches_.begin(), patches_.end(), Patch{}); }

BeamDecorrelation::Patch& BeamDecorrelation::patch_at(double x_m, double y_m) {
  const auto column = rounded_down(x_m / kPatchM);
  const auto row = rounded_down(y_m / kPatchM);
  Patch& patch = patches_[wrapped(row) * kAcross + wrapped(column)];
  const auto column_turn = static_cast<std::int8_t>(column >> kAcrossBits);
  const auto row_turn = static_cast<std::int8_t>(row >> kAcrossBits);
  if (patch.column_turn != column_turn || patch.row_turn != row_turn || scan_ - patch.met_at > kForgottenAfterScans)
    patch = {column_turn, row_turn, 0, scan_};
  patch.met_at = scan_;
  return patch;
}

std::span<const float> BeamDecorrelation::weights(const motion::BeamEnds& ends,
                                                  const Pose2& continuous_odom_from_robot) {
  ++scan_;
  weights_.resize(ends.size());
  float sum = 0.0F;
  for (std::size_t i = 0; i < ends.size(); ++i) {
    const Point2 end =
        continuous_odom_from_robot * Point2{static_cast<double>(ends.x_m[i]), static_cast<double>(ends.y_m[i])};
    Patch& patch = patch_at(end.x(), end.y());
    weights_[i] = 1.0F / (1.0F + static_cast<float>(patch.beams));
    if (patch.beams < std::numeric_limits<std::uint16_t>::max()) ++patch.beams;
    sum += weights_[i];
  }
  const float most = kMostOfAScan * static_cast<float>(ends.size());
  if (sum > most) {
    for (float& weight : weights_) weight *= most / sum;
  }
  return weights_;
}

}  // namespace deltamap::localization::hypotheses
