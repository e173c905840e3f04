// SPDX-License-Identifier: Apache-2.0
#include "localization/localizer.hpp"

#include <utility>

#include "localization/localizer_state.hpp"

namespace deltamap::localization {

Localizer::Localizer(const LocalizerParams& params, std::shared_ptr<const OccupancyGrid> map,
                     std::optional<particles::InitialPose> initial_pose, std::uint64_t seed)
    : state_{std::make_unique<State>(params, std::move(map), seed)} {
  if (initial_pose) {
    state_->start_at(*initial_pose);
  } else {
    state_->start_anywhere();
  }
}

Localizer::~Localizer() = default;
Localizer::Localizer(Localizer&&) noexcept = default;
Localizer& Localizer::operator=(Localizer&&) noexcept = default;

void Localizer::observe(const Odometry& odometry) { state_->take(odometry); }

std::optional<Pose2> Localizer::odom_from_robot(Timestamp time) const {
  const auto odometry = state_->odometry.at(time);
  return odometry ? std::optional{odometry->continuous_odom_from_robot} : std::nullopt;
}

TrackedScan Localizer::observe(Scan scan) {
  State& state = *state_;
  TrackedScan tracked;
  if (state.last_scan && scan.time < *state.last_scan) state.odometry.clock_fell_back(*state.last_scan);
  const motion::BodyVelocity velocity = state.odometry.velocity_at(scan.time);
  scan.range_deviation_m = state.params.range_deviation_m;
  if (const auto known = state.tracker.calibration()) {
    state.odometry.calibrate(known->wheels);
    scan.robot_from_laser = known->mount_error * scan.robot_from_laser;
  }
  tracked.rays = motion::deskewed(scan, velocity);
  const motion::ScanInstant now = state.witnessed(scan, tracked.rays);
  state.ends = motion::scoring_ends(scan, tracked.rays, state.params.beams, std::move(state.ends));
  state.faces.begin(scan, tracked.rays);
  state.velocity = velocity;
  state.note_oddities(now);
  state.leave_out_unmapped(scan.robot_from_laser.position(), now);
  const sensor::RefinedPose believed = state.believed(now);
  state.judge(scan, tracked.rays, now, believed);

  tracked.estimate = state.estimate(scan.time, believed);
  if (now.odometry) {
    tracked.odom_from_robot = now.odometry->continuous_odom_from_robot;
    tracked.odometry_epoch = now.odometry->epoch;
  }
  tracked.stood_m = state.stood_m;
  tracked.speed_m_per_s = velocity.speed_m_per_s;
  tracked.turn_rate_rad_per_s = velocity.turn_rate_rad_per_s;
  tracked.scan = std::move(scan);
  return tracked;
}

void Localizer::apply(const MapRevision& revision) {
  State& state = *state_;
  const bool follows = revision.number == state.revision + 1 && revision.map->geometry() == state.map->geometry();
  if (follows && (revision.changes.empty() || !revision.field_patch.box.empty())) {
    state.field.apply(revision.field_patch);
    state.hypotheses.apply(*revision.map, state.field, revision.field_patch.box);
    state.judgement.forget(revision.changes);
  } else {
    state.field = sensor::LikelihoodField{*revision.map, state.params.field};
    state.judgement.forget(*state.map, *revision.map);
    state.hypotheses.apply(*revision.map, state.field, revision.map->box());
  }
  state.tracker.apply(revision.map, follows ? bounding_box(revision.changes) : revision.map->box());
  state.map = revision.map;
  state.revision = revision.number;
}

void Localizer::apply(std::shared_ptr<const TransientObstacles> transients) {
  state_->transients = std::move(transients);
}

bool Localizer::relocalize(const particles::InitialPose& pose) {
  if (particles::usable_start(*state_->map, pose).kind == particles::StartKind::kAnywhere) return false;
  state_->start_at(pose);
  ++state_->counts.relocalizations;
  return true;
}

std::optional<double> Localizer::fit() const { return state_->newest_fit; }

std::optional<double> Localizer::fit_of_all() const { return state_->newest_fit_of_all; }

std::optional<sensor::OtherScale> Localizer::range_scale() const { return state_->range_scale.shown(); }

std::optional<motion::DriveCalibration> Localizer::calibration() const { return state_->tracker.calibration(); }

const particles::ParticleSet* Localizer::particles() const {
  return state_->searches() ? nullptr : state_->tracker.particles();
}

const LocalizerCounts& Localizer::counts() const { return state_->counts; }

belief::StabilityRecord Localizer::stability() const { return state_->judgement.stability().record(); }

bool Localizer::restore(const belief::StabilityRecord& record) { return state_->judgement.restore(record); }

void Localizer::restore(const motion::DriveCalibration& learned) {
  state_->tracker.restore(learned);
  if (const auto known = calibration()) state_->odometry.calibrate(known->wheels);
}

FieldPatch prepared_field_patch(const LocalizerParams& params, const OccupancyGrid& map,
                                std::span<const CellChange> changes) {
  return sensor::field_patch(map, changes, params.field);
}

}  // namespace deltamap::localization
