// SPDX-License-Identifier: Apache-2.0
// Matches one scan against another: where did the second robot pose stand, seen from the first, with its covariance.
// The pairwise spatial relations of the alignment (paper §3.3; Lu and Milios, "Globally consistent range scan alignment
// for environment mapping", 1997, §4–5), by closest lines.
#pragma once

#include <optional>
#include <span>

#include "mapping/registration/registration.hpp"

namespace deltamap::mapping::alignment {

struct ScanMatchingParams {
  double longest_m = 15.0;                ///< longer ranges are left out: their ends lie too far apart; > 0
  double first_reach_m = 0.5;             ///< how wrong the initial pose may place a point
  double last_reach_m = 0.1;              ///< pairs at the end
  double independent_share = 0.25;        ///< of the paired points whose errors are their own; (0, 1]
  double unobserved_deviation_m = 1.0;    ///< σ along an axis that the scans do not observe (a corridor)
  double unobserved_deviation_rad = 0.2;  ///< the same in heading
  double least_overlap = 0.5;      ///< share of the second scan's ends that must lie on the first's surface; [0, 1]
  double most_deviation_m = 0.06;  ///< root mean square distance of the paired ends
  double most_correction_m = 0.6;  ///< from the initial pose: farther is another minimum
  double most_correction_rad = 0.3;
};

/// A scan made ready for matching, in its robot's frame.
struct MatchableScan {
  std::vector<Point2> ends;
  registration::NearestSurface surface;
  double range_deviation_m = kRangeDeviationM;  ///< Scan::range_deviation_m
};
[[nodiscard]] MatchableScan matchable(const TrackedScan& tracked, const ScanMatchingParams& params);

struct ScanMatch {
  Pose2 first_from_second;
  PoseCovariance covariance = PoseCovariance::Zero();  ///< of (x, y, θ) of first_from_second
};

/// Nothing where the scans do not overlap enough or do not fit.
[[nodiscard]] std::optional<ScanMatch> scan_match(const MatchableScan& first, const MatchableScan& second,
                                                  const Pose2& initial_first_from_second,
                                                  const ScanMatchingParams& params);

}  // namespace deltamap::mapping::alignment
