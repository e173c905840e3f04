// SPDX-License-Identifier: Apache-2.0
#include "localization/belief/known_ground.hpp"

#include <algorithm>

#include "core/geometry/principal_axes.hpp"

namespace deltamap::localization::belief {
namespace {

constexpr double kLeastBeams = 3.0;   // that fit, in each direction
constexpr double kLeastShare = 0.6;   // of those that reach what known ground expects
constexpr double kDrawnShare = 0.25;  // of what known ground shows: less is a patch behind a door
constexpr double kLeftAfterM = 1.0;
constexpr double kBackAfterM = 1.0;
constexpr double kOutOfViewM = 10.0;  // nothing drawn is in view any more: whatever has changed, the pose rests on none

/// What one side of the rim says about the pose, along the axes of the map that surfaces of it face most and least.
struct Told {
  Eigen::Matrix2d fit = Eigen::Matrix2d::Zero();  // second moments of the normals
  Eigen::Matrix2d all = Eigen::Matrix2d::Zero();

  void add(const CheckedBeam& beam) {
    if (beam.what == BeamFit::kShort) return;  // what stands before it tells nothing of where it is
    const Eigen::Matrix2d moment = beam.normal * beam.normal.transpose();
    all += moment;
    if (beam.what == BeamFit::kFit) fit += moment;
  }
  [[nodiscard]] bool holds() const {
    const PrincipalAxes axes = principal_axes(fit);
    for (Eigen::Index i = 0; i < 2; ++i) {
      const Eigen::Vector2d axis = axes.vectors.col(i);
      if (axes.values[i] < kLeastBeams || axes.values[i] < kLeastShare * axis.dot(all * axis)) return false;
    }
    return true;
  }
};

}  // namespace

void KnownGround::observe(std::span<const CheckedBeam> beams, const GridGeometry& map, double driven_m) {
  Told known;
  double drawn = 0.0;
  for (const CheckedBeam& beam : beams) {
    if (beam.what == BeamFit::kSilent) continue;
    const Cell then = begun_with_.geometry().cell_at(map.centre_of(beam.expected));
    if (begun_with_.at(then) != CellState::kUnknown) {
      known.add(beam);
    } else {
      drawn += beam.what == BeamFit::kFit ? 1.0 : 0.0;
    }
  }
  const bool holds = known.holds();
  const bool rests_on_drawn = drawn >= kLeastBeams && drawn > kDrawnShare * known.fit.trace();
  without_m_ = holds || !rests_on_drawn ? 0.0 : without_m_ + driven_m;
  held_m_ = holds ? held_m_ + driven_m : 0.0;
  out_of_view_m_ = drawn < kLeastBeams ? out_of_view_m_ + driven_m : 0.0;
  if (without_m_ > kLeftAfterM) is_left_ = true;
  if (held_m_ > kBackAfterM || out_of_view_m_ > kOutOfViewM) is_left_ = false;
}

}  // namespace deltamap::localization::belief
