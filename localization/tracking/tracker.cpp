// SPDX-License-Identifier: Apache-2.0
#include "localization/tracking/tracker.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/geometry/principal_axes.hpp"
#include "localization/sensor/weighing.hpp"
#include "localization/tracking/surface_tracker.hpp"

namespace deltamap::localization::tracking {
namespace {

// The particles lie as close as one Gaussian that surfaces can go on from.
constexpr double kOnePlaceShare = 0.98;

constexpr double kAroundSlip = 0.1;  // of a usual slip: how far particles are spread once a slip fits best

}  // namespace

Tracker::Tracker(const TrackerParams& params, std::shared_ptr<const OccupancyGrid> map, std::uint64_t seed)
    : params_{params},
      filter_{params.particles, seed},
      pose_filter_{params.wheels, params.motion},
      slip_finder_{params.motion, params.refinement} {
  if (!params.follow_surfaces) return;
  surfaces_ =
      std::make_unique<SurfaceTracker>(params.wheels, params.motion, params.particles.evidence_beams, std::move(map));
}

Tracker::~Tracker() = default;

void Tracker::apply(std::shared_ptr<const OccupancyGrid> map, const CellBox& changed) {
  if (surfaces_) surfaces_->apply(std::move(map), changed);
}

const particles::ParticleSet* Tracker::particles() const {
  return surfaces_ && surfaces_->leads() ? nullptr : &filter_.particles();
}

bool Tracker::is_fixed_by_surfaces() const { return surfaces_ && surfaces_->is_fixed_by_surfaces(); }

std::optional<motion::DriveCalibration> Tracker::calibration() const {
  return surfaces_ ? std::optional{surfaces_->calibration()} : std::nullopt;
}

void Tracker::restore(const motion::DriveCalibration& learned) {
  if (surfaces_) surfaces_->restore(learned);
}

Tracker::NotCounted Tracker::not_counted_in(const sensor::RefinedPose& believed) const {
  NotCounted more;
  if (!surfaces_) return more;
  const surfaces::UnknownOfCells unknown = surfaces_->unknown_of_cells();
  const Eigen::Matrix2d beyond = unknown.scattered - believed.covariance.topLeftCorner<2, 2>();
  const PrincipalAxes axes = principal_axes(beyond);
  more.noise.topLeftCorner<2, 2>() = axes.vectors * axes.values.cwiseMax(0.0).asDiagonal() * axes.vectors.transpose();
  more.bias.topLeftCorner<2, 2>() = unknown.alike;
  if (surfaces_->leads()) return more;
  // From scan to scan the particles' pose is as sure as the scans make it; the mount errs alike in all of them.
  more.bias += more.noise;
  const Pose2 deviations = surfaces_->calibration().mount_deviations;
  more.noise = motion::covariance_along(believed.map_from_robot.theta, deviations.x * deviations.x,
                                        deviations.y * deviations.y, deviations.theta * deviations.theta);
  return more;
}

sensor::RefinedPose Tracker::start_around(const particles::InitialPose& pose) {
  const double position_m2 = pose.position_deviation_m * pose.position_deviation_m;
  const double heading_rad2 = pose.heading_deviation_rad * pose.heading_deviation_rad;
  const PoseCovariance spread = motion::covariance_along(0.0, position_m2, position_m2, heading_rad2);
  return start_around({pose.map_from_robot, spread});
}

/// A scan guides a particle over decimetres: where the robot may be farther off, few would settle on whatever fits
/// nearest.
std::size_t Tracker::particles_for(const PoseCovariance& spread) const {
  const bool one_place = SurfaceTracker::is_one_place(spread);
  return static_cast<std::size_t>(one_place ? params_.particles.min : params_.particles.max);
}

sensor::RefinedPose Tracker::start_around(const sensor::RefinedPose& pose) {
  filter_.start_around(pose.map_from_robot, pose.covariance, particles_for(pose.covariance));
  best_ = clusters_.best(filter_.particles());
  drawn_anew_ = false;
  pose_filter_.forget();
  if (surfaces_) surfaces_->cease();
  slip_finder_.forget();
  last_update_.reset();
  has_driven_blind_ = false;
  return {best_.map_from_robot, best_.covariance};
}

sensor::RefinedPose Tracker::start_around(const particles::InitialPose& pose, const motion::ScanInstant& now) {
  sensor::RefinedPose believed = start_around(pose);
  last_update_ = now;
  return believed;
}

void Tracker::restart_clock(Timestamp time) {
  if (last_update_) last_update_->time = time;
}

Tracker::Answer Tracker::observe(const SeenScan& seen) {
  const motion::MotionSince since =
      last_update_ ? motion::motion_since(*last_update_, seen.now, params_.update.time_s) : motion::MotionSince{};
  const bool are_led = surfaces_ && surfaces_->leads();
  Answer answer = are_led ? led_by_surfaces(seen) : update_due(since) ? update(seen, since) : follow(seen, since);
  answer.unknown_s = since.unknown_s;
  if (surfaces_ && surfaces_->leads()) return answer;
  pose_filter_.after_scan(seen.now, answer.believed);
  if (surfaces_ && seen.ends.size() > 0) {
    surfaces_->learn_from(answer.believed, seen.now, seen.velocity);
    let_surfaces_lead(seen, answer);
  }
  return answer;
}

/// The particles rest. Where surfaces cease to lead, they begin anew around the pose, as unsure as it is, at this very
/// scan.
Tracker::Answer Tracker::led_by_surfaces(const SeenScan& seen) {
  Answer answer;
  answer.believed = surfaces_->observe(seen);
  const Pose2& pose = answer.believed.map_from_robot;
  if (!surfaces_->leads()) {
    const bool looked_around = start_within(answer.believed, seen);
    answer = update(seen, {});
    answer.looked_around = looked_around;
    return answer;
  }
  has_driven_blind_ = false;
  answer.n_eff = static_cast<double>(particle_count());
  if (seen.ends.size() > 0) answer.w_avg = sensor::mean_likelihood(seen.field, seen.ends, pose);
  best_ = {pose, answer.believed.covariance, 1.0};
  last_update_ = seen.now;
  return answer;
}

void Tracker::let_surfaces_lead(const SeenScan& seen, Answer& answer) {
  const PoseCovariance& spread = best_.covariance;
  const bool one_place = best_.weight > kOnePlaceShare && SurfaceTracker::is_one_place(spread);
  if (!one_place || !surfaces_->could_lead(seen, answer.believed.map_from_robot)) return;
  answer.believed = surfaces_->lead_from({answer.believed.map_from_robot, answer.believed.covariance + spread}, seen);
}

void Tracker::predict(const motion::ScanInstant& now) {
  if (!last_update_) return;
  if (surfaces_) surfaces_->predict(now);
  if (surfaces_ && surfaces_->leads()) {
    last_update_ = now;
    has_driven_blind_ = true;
    return;
  }
  const motion::MotionSince since = motion::motion_since(*last_update_, now, params_.update.time_s);
  if (!update_due(since)) return;
  motion::MotionModelParams motion = noise_of(since);
  motion.slip_probability = 0.0;  // only a scan can tell of a slip
  filter_.move(since.motion, since.unknown_s, motion);
  last_update_ = now;
  has_driven_blind_ = true;
  pose_filter_.predict(now);
}

motion::MotionModelParams Tracker::noise_of(const motion::MotionSince& since) const {
  const motion::MotionModelParams wheels = pose_filter_.particle_motion();
  return since.by_scans ? motion::as_unsure(wheels, since.slipped) : motion::less_sure(wheels, since.slipped);
}

bool Tracker::update_due(const motion::MotionSince& since) const {
  return !last_update_ || has_driven_blind_ || since.motion.position().norm() >= params_.update.distance_m ||
         std::abs(since.motion.theta) >= params_.update.turn_rad || since.passed_s >= params_.update.time_s;
}

/// Moves and weighs the particles; they may be drawn anew afterwards.
Tracker::Answer Tracker::update(const SeenScan& seen, const motion::MotionSince& since) {
  const bool sees = seen.ends.size() > 0;
  const motion::MotionModelParams motion = noise_of(since);
  if (last_update_) filter_.move(since.motion, since.unknown_s, motion);
  last_update_ = seen.now;
  if (!sees && surfaces_) surfaces_->predict(seen.now);
  const bool looked_around = sees && has_driven_blind_ && gather(seen);
  has_driven_blind_ = false;
  const std::span<const Pose2> slips_that_fit = sees ? slips(seen) : std::span<const Pose2>{};
  filter_.propose_slips(slips_that_fit);
  std::span<const std::int32_t> misfits;
  if (sees) misfits = filter_.weigh(seen.field, seen.ends);
  if (!slips_that_fit.empty() && filter_.best_has_slipped()) {
    filter_.spread_chosen(params_.motion, kAroundSlip);
    misfits = filter_.weigh(seen.field, seen.ends);
  }
  Answer answer;
  answer.looked_around = looked_around;
  answer.n_eff = filter_.n_eff();
  best_ = clusters_.best(filter_.particles());
  answer.believed = pose_filter_.before_scan(seen.now, best_);
  if (!sees) return answer;
  answer.w_avg = mean_over_members(misfits, seen.ends.size());
  answer.believed = refined(seen, answer.believed);
  draw_anew_if_needed();
  return answer;
}

/// A drive without scans may have drawn the particles apart: they begin anew where the wheels, as they have been
/// calibrated, tell that the robot may be. True where that is more than one place.
bool Tracker::gather(const SeenScan& seen) {
  const particles::ParticleCluster apart = clusters_.best(filter_.particles());
  if (SurfaceTracker::is_one_place(apart.covariance)) return false;
  const std::optional<sensor::RefinedPose> by_wheels = surfaces_ ? surfaces_->predict(seen.now) : std::nullopt;
  return start_within(by_wheels.value_or(sensor::RefinedPose{apart.map_from_robot, apart.covariance}), seen);
}

/// Where no scan has come and the prior is more than one place, particles also begin where the scan fits within it, and
/// the answer is true. Scans that came and showed nothing do not count: where the map knows nothing, what it knows
/// elsewhere fits better than the truth.
bool Tracker::start_within(const sensor::RefinedPose& prior, const SeenScan& seen) {
  const bool was_blind = has_driven_blind_;
  const bool sees = seen.ends.size() > 0;
  (void)start_around(prior);
  last_update_ = seen.now;
  if (!was_blind || !sees || SurfaceTracker::is_one_place(prior.covariance)) return false;
  if (seen.poses_within) filter_.propose(seen.poses_within(prior));
  return true;
}

/// Between updates: the particles stay, the answer follows the wheels and the scan.
Tracker::Answer Tracker::follow(const SeenScan& seen, const motion::MotionSince& since) {
  particles::ParticleCluster moved = best_;
  moved.map_from_robot = best_.map_from_robot * since.motion;
  Answer answer;
  answer.believed = pose_filter_.before_scan(seen.now, moved);
  if (seen.ends.size() == 0) return answer;
  if (drawn_anew_) best_.weight = clusters_.best(filter_.particles()).weight;
  drawn_anew_ = false;
  answer.w_avg = mean_over_some_members(seen, since.motion);
  answer.believed = refined(seen, answer.believed);
  return answer;
}

std::span<const Pose2> Tracker::slips(const SeenScan& seen) {
  const std::optional<Pose2> by_wheels = pose_filter_.predicted_at(seen.now);
  if (!by_wheels) return {};
  return slip_finder_.slips(seen.field, seen.ends, *by_wheels, beam_share(seen));
}

double Tracker::mean_over_members(std::span<const std::int32_t> misfits, std::size_t beams) const {
  double sum = 0.0;
  for (const std::uint32_t i : clusters_.members()) sum += sensor::mean_likelihood(misfits[i], beams);
  return sum / static_cast<double>(clusters_.members().size());
}

/// Evenly chosen: enough to know the mean over all of them.
double Tracker::mean_over_some_members(const SeenScan& seen, const Pose2& motion) const {
  constexpr std::size_t kEnough = 50;
  const std::span<const std::uint32_t> members = clusters_.members();
  const std::size_t count = std::min(kEnough, members.size());
  double sum = 0.0;
  for (std::size_t nth = 0; nth < count; ++nth) {
    const Pose2 standing = filter_.particles().pose(members[nth * members.size() / count]);
    sum += sensor::mean_likelihood(sensor::misfit_steps(seen.field, seen.ends, standing * motion), seen.ends.size());
  }
  return sum / static_cast<double>(count);
}

/// The pose where the scan fits best.
sensor::RefinedPose Tracker::refined(const SeenScan& seen, const sensor::RefinedPose& prior) {
  const sensor::Refinement found =
      sensor::refined(seen.field, seen.ends, prior, best_.covariance, errors_, beam_share(seen), params_.refinement);
  errors_ = found.errors;
  slip_finder_.learn(seen.field, seen.ends, found.pose.map_from_robot);
  return found.pose;
}

double Tracker::beam_share(const SeenScan& seen) const {
  return std::min(1.0, params_.particles.evidence_beams / static_cast<double>(seen.ends.size()));
}

void Tracker::draw_anew_if_needed() {
  const std::size_t before = filter_.particles().size();
  const bool drawn = filter_.resample_if_needed(clusters_.cell_count());
  // Where all belonged to the heaviest cluster, all that were drawn from them do.
  drawn_anew_ = drawn && (clusters_.members().size() != before || filter_.particles().size() != before);
}

}  // namespace deltamap::localization::tracking
