// SPDX-License-Identifier: Apache-2.0
// Where a scan lies on a submap: the best pose of a window by correlation, then refined onto the surfaces by closest
// lines.
#pragma once

#include <optional>
#include <span>

#include "mapping/registration/registration.hpp"
#include "surveying/slam/correlation_field.hpp"
#include "surveying/slam/survey.hpp"

namespace deltamap::surveying::slam {

struct SubmapMatchParams {
  double least_score = 0.4;        ///< mean likelihood of the ends by correlation, [0, 1]
  double least_paired = 0.4;       ///< share of the ends that must lie on a surface, [0, 1]
  double most_deviation_m = 0.07;  ///< root mean square distance of these from it
  double ambiguous_share = 1.0;    ///< refused where another place reaches this share of the score; >= 1: never
  double inner_deviation_m = 0.0;  ///< 1 σ by which scan and submap are bent themselves
  double inner_deviation_rad = 0.0;
};

struct SubmapMatch {
  Pose2 submap_from_scan;
  PoseCovariance covariance = PoseCovariance::Zero();  ///< of its (x, y, θ), together with what was known before
  double score = 0.0;
  bool is_at_rim = false;  ///< of the window, beyond which the scan may fit better
};

inline constexpr double kMostWindowM = 8.0;  ///< searched to each side, whatever is known
/// Around where a scan is expected, as far as that may be off.
[[nodiscard]] SearchWindow window_of(const Pose2& expected, const PoseCovariance& unsure);

class SubmapMatcher {
 public:
  /// `reach_m`: half the side of the largest window that is to be searched fast.
  SubmapMatcher(Submap submap, double reach_m);

  /// Half the side of a square around everything that the submap shows, and its middle.
  [[nodiscard]] const SearchWindow& everywhere() const { return everywhere_; }

  /// `known`: what is known of submap_from_scan before, such as the wheels tell; the window's centre is its pose then.
  /// `ends` in the scan's frame, with `range_deviation_m` (Scan::range_deviation_m).
  [[nodiscard]] std::optional<SubmapMatch> match(std::span<const Point2> ends, double range_deviation_m,
                                                 const SearchWindow& window,
                                                 const mapping::registration::PoseBelief& known,
                                                 const SubmapMatchParams& params) const;

 private:
  SearchWindow everywhere_;
  CorrelationField field_;
  std::vector<mapping::registration::SurfacePoint> points_;
};

}  // namespace deltamap::surveying::slam
