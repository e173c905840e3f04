// SPDX-License-Identifier: Apache-2.0
// Why about the pose and not at it: a scan of another scale has pulled the pose aside, and the more so the farther away
// its walls are.
#include "localization/sensor/range_scale.hpp"

#include <algorithm>
#include <limits>

#include "localization/sensor/pose_refinement.hpp"
#include "localization/sensor/weighing.hpp"

namespace deltamap::localization::sensor {
namespace {

constexpr double kEachM = 0.5;           // driven from one look to the next
constexpr std::size_t kFewestEnds = 30;  // of a scan that can tell
constexpr int kFewestScans = 8;          // before a factor is named,
constexpr int kManyScans = 24;           // before ranges have proven right,
constexpr int kMostScans = 32;           // what is older counts less and less
constexpr double kClearlyMore = 0.08;    // share of the ends,
constexpr double kExplains = 0.6;        // and so many must be explained at all
constexpr int kAside = 3;                // steps to each side
constexpr double kAsideStepM = 0.25;
const PoseCovariance kAround = Eigen::Vector3d{0.04, 0.04, 0.003}.asDiagonal();

motion::BeamEnds scaled(const motion::BeamEnds& ends, const Point2& from, double factor) {
  motion::BeamEnds longer = ends;
  for (std::size_t i = 0; i < ends.size(); ++i) {
    longer.x_m[i] = static_cast<float>(from.x() + factor * (ends.x_m[i] - from.x()));
    longer.y_m[i] = static_cast<float>(from.y() + factor * (ends.y_m[i] - from.y()));
  }
  return longer;
}

/// The most of the scan that any pose about this one explains.
double explained_about(const LikelihoodField& field, const motion::BeamEnds& ends, const Pose2& pose) {
  Pose2 best = pose;
  std::int32_t least = std::numeric_limits<std::int32_t>::max();
  for (int along = -kAside; along <= kAside; ++along) {
    for (int aside = -kAside; aside <= kAside; ++aside) {
      const Pose2 here = pose * Pose2{kAsideStepM * along, kAsideStepM * aside, 0.0};
      const std::int32_t misfit = misfit_steps(field, ends, here);
      if (misfit >= least) continue;
      least = misfit;
      best = here;
    }
  }
  return explained_share(field, ends, refined(field, ends, {best, kAround}, 1.0, RefinementParams{}).map_from_robot);
}

}  // namespace

void RangeScale::observe(const LikelihoodField& field, const motion::BeamEnds& ends, const Point2& robot_from_laser,
                         const Pose2& map_from_robot, double driven_m) {
  if (is_settled_) return;
  since_tried_m_ += driven_m;
  if (since_tried_m_ < kEachM || ends.size() < kFewestEnds) return;
  since_tried_m_ = 0.0;
  Tried& tried = tried_[next_];
  const motion::BeamEnds longer = scaled(ends, robot_from_laser, kFactors[next_]);
  next_ = (next_ + 1) % kFactors.size();
  if (tried.scans == kMostScans) {
    tried.scans /= 2;
    tried.explained /= 2.0;
    tried.explained_as_is /= 2.0;
  }
  ++tried.scans;
  tried.explained += explained_about(field, longer, map_from_robot);
  tried.explained_as_is += explained_about(field, ends, map_from_robot);
  is_settled_ = shown() || has_proven_right();
}

bool RangeScale::has_proven_right() const {
  return std::all_of(tried_.begin(), tried_.end(), [](const Tried& one) {
    return one.scans >= kManyScans && one.explained_as_is >= kExplains * one.scans;
  });
}

std::optional<OtherScale> RangeScale::shown() const {
  std::optional<OtherScale> best;
  for (std::size_t i = 0; i < kFactors.size(); ++i) {
    const Tried& tried = tried_[i];
    if (tried.scans < kFewestScans) continue;
    const OtherScale other{kFactors[i], tried.explained / tried.scans, tried.explained_as_is / tried.scans};
    if (other.explained < kExplains || other.explained < other.explained_as_is + kClearlyMore) continue;
    if (!best || other.explained > best->explained) best = other;
  }
  return best;
}

}  // namespace deltamap::localization::sensor
