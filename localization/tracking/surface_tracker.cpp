// SPDX-License-Identifier: Apache-2.0
#include "localization/tracking/surface_tracker.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/geometry/principal_axes.hpp"
#include "localization/sensor/weighing.hpp"

namespace deltamap::localization::tracking {
namespace {

constexpr double kLeadsAbove = 0.82;  // share of ends on straight surfaces: what a hall of walls and containers shows
constexpr double kCeasesBelow = 0.3;
constexpr double kFixedAbove = 0.3;  // of the surfaces that fix the pose
// What one Gaussian can hold, that surfaces are told apart from.
constexpr double kOnePlaceM = 0.15;
const double kOnePlaceRad = radians(4.0);
constexpr double kNewest = 0.1;             // share of one keyframe in the running means
const double kKeyframeRad = radians(10.0);  // turned since the last keyframe
constexpr double kSuddenly = 0.1;           // share of ends that the map ceases to explain: the wheels may have slipped
// How far a pose that the particles have found is off, besides what they say: cells, and a map drawn a little wrong.
const PoseCovariance kOfAPose = Eigen::Vector3d{9e-4, 9e-4, 2.5e-5}.asDiagonal();
constexpr double kMostSurprise = 25.0;  // squared deviations: a slip is no measure of how the wheels usually do
constexpr double kLongestStepM = 0.5;   // of one correction

/// Along an axis in which the particles are less sure than a scan would make them they tell what the wheels have told.
PoseCovariance unobserved_along(const PoseCovariance& spread) {
  constexpr double kNothing_m2 = 100.0;
  const PrincipalAxes axes = principal_axes(spread.topLeftCorner<2, 2>());
  PoseCovariance more = PoseCovariance::Zero();
  for (Eigen::Index i = 0; i < 2; ++i) {
    const Eigen::Vector2d axis = axes.vectors.col(i);
    if (axes.values[i] > kOfAPose(0, 0)) more.topLeftCorner<2, 2>() += kNothing_m2 * axis * axis.transpose();
  }
  return more;
}

}  // namespace

SurfaceTracker::SurfaceTracker(const OdometryNoiseParams& wheels, const motion::MotionModelParams& motion,
                               double evidence_beams, std::shared_ptr<const OccupancyGrid> map)
    : motion_{motion}, odometry_noise_{wheels}, evidence_beams_{evidence_beams}, filter_{std::move(map)} {}

void SurfaceTracker::apply(std::shared_ptr<const OccupancyGrid> map, const CellBox& changed) {
  filter_.apply(std::move(map), changed);
}

bool SurfaceTracker::could_lead(const SeenScan& seen, const Pose2& map_from_robot) {
  const surfaces::OffsetFilter::SeenByMap shown = filter_.seen_by_map(seen.field, seen.faces.faces(), map_from_robot);
  unknown_by_map_ = shown.unknown;
  straight_ += kNewest * (shown.straight - straight_);
  return straight_ >= kLeadsAbove;
}

void SurfaceTracker::learn_from(const sensor::RefinedPose& found, const motion::ScanInstant& now,
                                const motion::BodyVelocity& velocity) {
  unknown_by_map_ = {};
  const bool begins = !last_;
  if (!begins) {
    step_to(now, velocity);
    if (!has_moved()) return;
  }
  const sensor::RefinedPose measured{found.map_from_robot,
                                     found.covariance + kOfAPose + unobserved_along(found.covariance)};
  begins ? filter_.start(measured) : filter_.take(measured);
  last_ = Last{now, velocity};
  since_ = SinceKeyframe{};
}

sensor::RefinedPose SurfaceTracker::lead_from(const sensor::RefinedPose& at, const SeenScan& seen) {
  filter_.start(at);
  odometry_noise_.forget_stretch();
  leads_ = true;
  last_ = Last{seen.now, seen.velocity};
  since_.reset();
  holding_ = 0.0;
  since_held_m_ = surfaces::kForgottenAfterM;
  return keyframe(seen);
}

surfaces::UnknownOfCells SurfaceTracker::unknown_of_cells() const {
  return leads_ ? filter_.unknown_of_cells() : unknown_by_map_;
}

PoseCovariance SurfaceTracker::noise(const Pose2& motion, const motion::MotionSince& step) const {
  if (step.by_scans) return motion::unknown_motion_covariance(motion_, step.unknown_s) + step.slipped.covariance();
  PoseCovariance added = odometry_noise_.added(motion, filter_.believed().map_from_robot.theta);
  added += motion::unknown_motion_covariance(motion_, step.unknown_s) + step.slipped.covariance();
  // Raised where corrections exceed what was expected, never lowered.
  added.topLeftCorner<2, 2>() *= std::max(1.0, surprise_m_);
  added(2, 2) *= std::max(1.0, surprise_rad_);
  return added;
}

void SurfaceTracker::step_to(const motion::ScanInstant& now, const motion::BodyVelocity& velocity) {
  motion::WheelStep step{.motion = motion::counted_between(last_->instant, now)};
  if (now.odometry && last_->instant.odometry) {
    step.speed_change_m_per_s = velocity.speed_m_per_s - last_->velocity.speed_m_per_s;
    step.turn_rate_change_rad_per_s = velocity.turn_rate_rad_per_s - last_->velocity.turn_rate_rad_per_s;
  }
  const Pose2 corrected = filter_.corrected(step);
  const motion::MotionSince since = motion::step_between(last_->instant, now);
  const PoseCovariance added = noise(corrected, since);
  filter_.predict(step, added);
  last_ = Last{now, velocity};
  since_held_m_ += step.motion.position().norm();
  if (!since_) return;
  since_->by_wheels = since_->by_wheels * step.motion;
  since_->corrected = since_->corrected * corrected;
  since_->wheels_told = since_->wheels_told && since.unknown_s == 0.0;
  since_->contradicted = since_->contradicted || !since.slipped.is_none();
}

bool SurfaceTracker::is_one_place(const PoseCovariance& spread) {
  return spread(0, 0) + spread(1, 1) < kOnePlaceM * kOnePlaceM && spread(2, 2) < kOnePlaceRad * kOnePlaceRad;
}

bool SurfaceTracker::has_moved() const {
  return since_->by_wheels.position().norm() >= surfaces::kKeyframeM ||
         std::abs(since_->by_wheels.theta) >= kKeyframeRad;
}

bool SurfaceTracker::is_due(const SeenScan& seen) const {
  if (!since_ || !since_->wheels_told || has_moved()) return true;
  const double explained = sensor::explained_share(seen.field, seen.ends, filter_.believed().map_from_robot);
  return explained < since_->explained - kSuddenly;
}

std::optional<sensor::RefinedPose> SurfaceTracker::predict(const motion::ScanInstant& now) {
  if (!last_) return std::nullopt;
  step_to(now, last_->velocity);
  return filter_.believed();
}

sensor::RefinedPose SurfaceTracker::observe(const SeenScan& seen) {
  step_to(seen.now, seen.velocity);
  if (!is_one_place(filter_.believed().covariance)) {
    cease();
    return filter_.believed();
  }
  const bool is_keyframe = is_due(seen) && !seen.faces.faces().ends.empty();
  return is_keyframe ? keyframe(seen) : filter_.believed();
}

sensor::RefinedPose SurfaceTracker::keyframe(const SeenScan& seen) {
  const surfaces::FacedScan faces = seen.faces.faces();
  const double share =
      std::min(1.0, evidence_beams_ / static_cast<double>(std::max<std::size_t>(1, faces.ends.size())));
  sensor::RefinedPose before = filter_.believed();
  const surfaces::OffsetFilter::Seen shown = filter_.observe(seen.field, faces, share, motion_);
  const bool has_slipped = shown.slipped || (since_ && since_->contradicted);
  if (has_slipped) odometry_noise_.forget_stretch();
  sensor::RefinedPose after = filter_.believed();
  const bool runs_away =
      !shown.slipped && distance_between(before.map_from_robot, after.map_from_robot) > kLongestStepM;
  if (!filter_.is_sound() || runs_away) {
    filter_.begin_anew();
    cease();
    return before;
  }
  if (since_ && !has_slipped) {
    learn_noise(before, after);
    odometry_noise_.learn(since_->corrected, after);
  }
  since_ = SinceKeyframe{};
  since_->explained = sensor::explained_share(seen.field, seen.ends, after.map_from_robot);
  straight_ += kNewest * (shown.straight - straight_);
  if (shown.displaced) holding_ = 0.0;
  holding_ += kNewest * (shown.holding - holding_);
  note_held(shown);
  if (straight_ < kCeasesBelow) cease();
  return after;
}

/// A pose that surfaces have held stays right while those that are followed stay where they are expected, moved or not:
/// for as long as they are followed, and the wheels do not slip.
void SurfaceTracker::note_held(const surfaces::OffsetFilter::Seen& shown) {
  if (std::min(holding_, shown.holding) >= kFixedAbove) {
    since_held_m_ = 0.0;
  } else if (shown.displaced || shown.followed < kFixedAbove) {
    since_held_m_ = surfaces::kForgottenAfterM;
  }
}

bool SurfaceTracker::is_fixed_by_surfaces() const { return leads_ && since_held_m_ < surfaces::kForgottenAfterM; }

void SurfaceTracker::learn_noise(const sensor::RefinedPose& before, const sensor::RefinedPose& after) {
  const Eigen::Vector3d correction = difference(before.map_from_robot, after.map_from_robot);
  const auto surprise = [&](Eigen::Index i) {
    const double gained = std::max(1e-6, before.covariance(i, i) - after.covariance(i, i));
    return std::min(kMostSurprise, correction[i] * correction[i] / gained);
  };
  surprise_m_ += kNewest * (0.5 * (surprise(0) + surprise(1)) - surprise_m_);
  surprise_rad_ += kNewest * (surprise(2) - surprise_rad_);
}

}  // namespace deltamap::localization::tracking
