// SPDX-License-Identifier: Apache-2.0
#include "localization/belief/view_tally.hpp"

#include <algorithm>
#include <cmath>

namespace deltamap::localization::belief {
namespace {

/// The direction in which the surfaces face most, from their normals' second moments.
Point2 principal_direction(std::span<const CheckedBeam> beams) {
  double xx = 0.0, xy = 0.0, yy = 0.0;
  for (const CheckedBeam& beam : beams) {
    xx += beam.normal.x() * beam.normal.x();
    xy += beam.normal.x() * beam.normal.y();
    yy += beam.normal.y() * beam.normal.y();
  }
  const double angle_rad = 0.5 * std::atan2(2.0 * xy, xx - yy);
  return {std::cos(angle_rad), std::sin(angle_rad)};
}

void count(BeamFit what, BeamCounts& counts) {
  ++counts.expected;
  counts.fit += what == BeamFit::kFit ? 1U : 0U;
  counts.short_of += what == BeamFit::kShort ? 1U : 0U;
  counts.beyond += what == BeamFit::kBeyond ? 1U : 0U;
}

/// Where the run of beams of the same kind ends that begins here.
std::size_t end_of_run(std::span<const CheckedBeam> beams, std::size_t begin) {
  std::size_t end = begin + 1;
  while (end < beams.size() && beams[end].what == beams[begin].what) ++end;
  return end;
}

/// One thing that has come or gone misleads many neighbouring beams: together they count as a few.
double weight_of_run(BeamFit what, std::size_t beams) {
  constexpr double kMostShort = 6.0;
  constexpr double kMostBeyond = 10.0;
  const double most = what == BeamFit::kShort ? kMostShort : kMostBeyond;
  return what == BeamFit::kFit ? 1.0 : std::min(1.0, most / static_cast<double>(beams));
}

void add(BeamFit what, double share, Support& support) {
  (what == BeamFit::kFit ? support.fit : what == BeamFit::kShort ? support.short_of : support.beyond) += share;
}

}  // namespace

ViewTally tallied(std::span<const CheckedBeam> beams, const Stability& stability) {
  const Point2 first = principal_direction(beams);
  ViewTally tally;
  for (std::size_t begin = 0, end = 0; begin < beams.size(); begin = end) {
    end = end_of_run(beams, begin);
    const BeamFit what = beams[begin].what;
    if (what == BeamFit::kSilent) continue;
    const double weight = weight_of_run(what, end - begin);
    for (const CheckedBeam& beam : beams.subspan(begin, end - begin)) {
      const bool stable = stability.proven(beam.expected);
      count(what, stable ? tally.stable : tally.elsewhere);
      std::array<Support, 2>& along = stable ? tally.stable_along : tally.elsewhere_along;
      const double in_first = beam.normal.dot(first) * beam.normal.dot(first);
      add(what, weight * in_first, along[0]);
      add(what, weight * (beam.normal.squaredNorm() - in_first), along[1]);
    }
  }
  return tally;
}

}  // namespace deltamap::localization::belief
