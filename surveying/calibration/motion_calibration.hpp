// SPDX-License-Identifier: Apache-2.0
// How far these wheels can be trusted: the deviations of the motion model, and the scales that it does not correct,
// that make the segments of a drive most likely. Variance components by minorization-maximization (Zhou, Hu, Zhou and
// Lange, "MM algorithms for variance components models", 2019); one segment in twenty may be ten times as far off (a
// slip).
#pragma once

#include <cstddef>
#include <span>

#include "surveying/calibration/motion_segments.hpp"

namespace deltamap::surveying::calibration {

/// A fitted number and its standard error.
struct Fitted {
  double value = 0.0;
  double error = 0.0;
};

struct MotionCalibration {
  std::array<Fitted, kMotionSources> deviation;  ///< of the model and of the estimate, by MotionSource
  Fitted wheel_scale;                            ///< true metres a metre of odometry, less 1
  Fitted turn_scale;                             ///< true turn a turn of odometry, less 1
  Fitted drift_rad_per_m;                        ///< true turn a metre of straight odometry
  double outlier_share = 0.0;                    ///< of the segments that are rather slips, [0, 1]

  [[nodiscard]] const Fitted& of(MotionSource source) const { return deviation[static_cast<std::size_t>(source)]; }
};

/// kLeftIn: the model is centred on the wheels as they are, and its deviations cover the scales too: what a localizer
/// needs that does not correct them. kTakenOut: the deviations are those around the fitted scales.
enum class Systematic { kLeftIn, kTakenOut };

/// `segments` must not be empty.
[[nodiscard]] MotionCalibration fitted_motion(std::span<const MotionSegment> segments, Systematic systematic);

}  // namespace deltamap::surveying::calibration
