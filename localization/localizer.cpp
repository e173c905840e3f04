// SPDX-License-Identifier: Apache-2.0
#include "localization/localizer.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <utility>

#include "localization/localizer_params.hpp"
#include "localization/weighing.hpp"

namespace deltamap::localization {
namespace {

constexpr std::uint64_t kSeedOfRivals = 0x52697661;
constexpr double kJumpBetweenEpochsS = 0.3;  // how long odometry counts as silent when its epoch changes

/// The last scan that changed the particles.
struct LastUpdate {
  Timestamp time;
  std::optional<OdometryAt> odometry;
  RefinedPose believed;
  double n_eff = 0.0;
};

struct MotionSince {
  Pose2 motion;
  double unknown_s = 0.0;
  double passed_s = 0.0;
};

std::shared_ptr<const OccupancyGrid> with_free_space(std::shared_ptr<const OccupancyGrid> map) {
  if (!map || count_of(*map, CellState::kFree) == 0) throw std::runtime_error("the map has no free cell to be in");
  return map;
}

/// What is known before the first scan: the middle of the map, give or take all of it.
Hypothesis anywhere_in(const OccupancyGrid& map) {
  const Point2 half = 0.5 * map.resolution_m() * Point2{map.width(), map.height()};
  const Point2 middle = map.geometry().origin + half;
  const double turn = std::numbers::pi;
  return {{middle.x(), middle.y(), 0.0},
          Eigen::Vector3d{half.x() * half.x() / 3.0, half.y() * half.y() / 3.0, turn * turn / 3.0}.asDiagonal(),
          0.0};
}

/// A pose and its covariance carried along a motion.
RefinedPose carried(const RefinedPose& believed, const MotionSince& since, const MotionModelParams& model) {
  const MotionNoise noise = motion_noise(turn_drive_turn(since.motion), since.unknown_s, model);
  const Pose2 pose = believed.map_from_robot * since.motion;
  Eigen::Matrix3d by_start = Eigen::Matrix3d::Identity();
  by_start(0, 2) = believed.map_from_robot.y - pose.y;
  by_start(1, 2) = pose.x - believed.map_from_robot.x;
  const double sideways_m = std::hypot(noise.sideways_m, noise.rot1_rad * since.motion.position().norm());
  const double position_m2 = std::max(noise.trans_m * noise.trans_m, sideways_m * sideways_m);
  const double heading_rad2 = noise.rot1_rad * noise.rot1_rad + noise.rot2_rad * noise.rot2_rad;
  const Eigen::Matrix3d added = Eigen::Vector3d{position_m2, position_m2, heading_rad2}.asDiagonal();
  return {pose, by_start * believed.covariance * by_start.transpose() + added};
}

}  // namespace

struct Localizer::State {
  State(const LocalizerParams& given, std::shared_ptr<const OccupancyGrid> first_map, std::uint64_t seed)
      : params{given},
        map{with_free_space(std::move(first_map))},
        field{*map, given.field},
        odometry{given.odometry},
        filter{given.particles, seed},
        hypotheses{given.hypothesis},
        monitor{given.fit},
        stability{map->geometry(), given.stability},
        rivals{given.rivals, given.places, given.global, *map, field, seed ^ kSeedOfRivals} {}

  LocalizerParams params;
  std::shared_ptr<const OccupancyGrid> map;
  std::uint32_t revision = 0;
  LikelihoodField field;
  OdometryBuffer odometry;
  ParticleFilter filter;
  HypothesisFinder hypotheses;
  FitMonitor monitor;
  Stability stability;
  Rivals rivals;
  Hypothesis best;
  BeamEnds ends;
  std::optional<LastUpdate> last_update;
  std::optional<Timestamp> last_scan;
  Pose2 last_joined;   ///< odometry at the last scan
  double w_avg = 1.0;  ///< before any scan nothing speaks against the pose

  void start_around(const InitialPose& pose) {
    filter.start_around(pose.map_from_robot, pose.position_deviation_m, pose.heading_deviation_rad);
    best = hypotheses.best(filter.particles());
    monitor.start(LocalizerState::kTracking);
    rivals.start_believing();
    last_update.reset();
  }

  void start_anywhere() {
    rivals.start_anywhere();
    best = anywhere_in(*map);
    monitor.start(LocalizerState::kGlobal);
    last_update.reset();
  }

  /// The best place that has come to mind leads, until it is believed.
  RefinedPose search(Timestamp time, const std::optional<OdometryAt>& now) {
    const Pose2 joined = now ? now->joined_from_robot : last_joined;
    const RivalReport& report = rivals.observe(field, {.ends = ends, .joined_from_robot = joined});
    if (const std::optional<Place> place = rivals.best_place()) {
      best = {place->map_from_robot, place->covariance, place->share};
      if (ends.size() > 0) w_avg = mean_likelihood(misfit_steps(field, ends, best.map_from_robot), ends.size());
    }
    const RefinedPose believed{best.map_from_robot, best.covariance};
    last_update = LastUpdate{time, now, believed, report.effective_places};
    return believed;
  }

  /// The particles start anew around a place that has won.
  void believe_in(const RefinedPose& place) {
    filter.start_around(place.map_from_robot, params.fit.converged_m / 2.0, params.fit.converged_rad / 2.0);
    best = hypotheses.best(filter.particles());
    rivals.start_believing();
  }

  [[nodiscard]] MotionSince motion_since_update(Timestamp time, const std::optional<OdometryAt>& now) const {
    if (!last_update) return {};
    MotionSince since;
    since.passed_s = std::max(0.0, seconds(time - last_update->time));
    if (!now || !last_update->odometry) {
      since.unknown_s = since.passed_s;
      return since;
    }
    since.motion = motion_between(last_update->odometry->joined_from_robot, now->joined_from_robot);
    since.unknown_s = std::min(now->uncovered_s, since.passed_s);
    if (now->epoch != last_update->odometry->epoch) since.unknown_s += kJumpBetweenEpochsS;
    return since;
  }

  [[nodiscard]] bool update_due(const MotionSince& since) const {
    return !last_update || since.motion.position().norm() >= params.update.distance_m ||
           std::abs(since.motion.theta) >= params.update.turn_rad || since.passed_s >= params.update.time_s;
  }

  [[nodiscard]] double beam_share() const {
    return std::min(1.0, params.particles.evidence_beams / static_cast<double>(ends.size()));
  }

  /// Moves and weighs the particles; they may be drawn anew afterwards.
  RefinedPose update(Timestamp time, const std::optional<OdometryAt>& now, const MotionSince& since) {
    if (last_update) filter.move(since.motion, since.unknown_s, params.motion);
    std::span<const std::int32_t> misfits;
    if (ends.size() > 0) misfits = filter.weigh(field, ends, params.particles.evidence_beams);
    const double n_eff = filter.n_eff();
    best = hypotheses.best(filter.particles());
    RefinedPose believed{best.map_from_robot, best.covariance};
    if (ends.size() > 0) {
      w_avg = mean_over_members(misfits);
      believed = refined(field, ends, believed, beam_share(), params.refinement);
      filter.resample_if_needed(hypotheses.cell_count());
    }
    last_update = LastUpdate{time, now, believed, n_eff};
    return believed;
  }

  [[nodiscard]] double mean_over_members(std::span<const std::int32_t> misfits) const {
    double sum = 0.0;
    for (const std::uint32_t i : hypotheses.members()) sum += mean_likelihood(misfits[i], ends.size());
    return sum / static_cast<double>(hypotheses.members().size());
  }

  /// Between updates: the particles stay, the answer follows the wheels and the scan.
  RefinedPose follow(const MotionSince& since) {
    RefinedPose prior = carried(last_update->believed, since, params.motion);
    if (ends.size() == 0) return prior;
    const Hypothesis standing = hypotheses.best(filter.particles());
    double sum = 0.0;
    for (const std::uint32_t i : hypotheses.members()) {
      sum += mean_likelihood(misfit_steps(field, ends, filter.particles().pose(i) * since.motion), ends.size());
    }
    w_avg = sum / static_cast<double>(hypotheses.members().size());
    best.weight = standing.weight;
    return refined(field, ends, prior, beam_share(), params.refinement);
  }

  RefinedPose believed(Timestamp time, const std::optional<OdometryAt>& now) {
    if (monitor.state() == LocalizerState::kGlobal) return search(time, now);
    const MotionSince since = motion_since_update(time, now);
    const RefinedPose believed = update_due(since) ? update(time, now, since) : follow(since);
    (void)rivals.observe(field, {.ends = ends,
                                 .joined_from_robot = now ? now->joined_from_robot : last_joined,
                                 .map_from_believed = believed.map_from_robot,
                                 .unknown_s = since.unknown_s});
    return believed;
  }

  void judge(Timestamp time, const std::optional<OdometryAt>& now, const RefinedPose& believed) {
    FitMonitor::Observation seen;
    if (last_scan) seen.passed_s = std::max(0.0, seconds(time - *last_scan));
    if (now && last_scan) {
      const Pose2 motion = motion_between(last_joined, now->joined_from_robot);
      seen.driven_m = motion.position().norm();
      seen.turned_rad = motion.theta;
    }
    if (now) last_joined = now->joined_from_robot;
    last_scan = time;
    if (ends.size() == 0) return;  // a scan that saw nothing says nothing
    seen.fit = explained_share(field, ends, believed.map_from_robot);
    const LocalizerState before = monitor.state();
    const LocalizerState after = monitor.observe(seen, best);
    if (before == LocalizerState::kGlobal && after == LocalizerState::kTracking) believe_in(believed);
    if (before == LocalizerState::kLost && after == LocalizerState::kGlobal) rivals.stop_believing();
    if (monitor.search_failed()) start_anywhere();
  }

  /// For a revision that does not follow on the present map.
  void forget_differences(const OccupancyGrid& next) {
    if (next.geometry() == map->geometry()) {
      stability.forget(changes_between(*map, next));
    } else {
      stability = Stability{next.geometry(), params.stability};
    }
  }

  [[nodiscard]] Estimate estimate(Timestamp time, const RefinedPose& believed) const {
    return {.time = time,
            .map_from_robot = believed.map_from_robot,
            .covariance = believed.covariance,
            .state = monitor.state(),
            .n_eff = last_update->n_eff,
            .particles = static_cast<std::uint32_t>(
                monitor.state() == LocalizerState::kGlobal ? rivals.report().places : filter.particles().size()),
            .w_avg = w_avg,
            .revision = revision,
            .map = map};
  }
};

Localizer::Localizer(const LocalizerParams& params, std::shared_ptr<const OccupancyGrid> map,
                     std::optional<InitialPose> initial_pose, std::uint64_t seed)
    : state_{std::make_unique<State>(params, std::move(map), seed)} {
  if (initial_pose) {
    state_->start_around(*initial_pose);
  } else {
    state_->start_anywhere();
  }
}

Localizer::~Localizer() = default;
Localizer::Localizer(Localizer&&) noexcept = default;
Localizer& Localizer::operator=(Localizer&&) noexcept = default;

void Localizer::observe(const Odometry& odometry) { state_->odometry.add(odometry); }

TrackedScan Localizer::observe(Scan scan) {
  State& state = *state_;
  TrackedScan tracked;
  const Timestamp time = scan.time;
  const std::optional<OdometryAt> now = state.odometry.at(time);
  const BodyVelocity velocity = state.odometry.velocity_at(time);
  tracked.rays = deskewed(scan, velocity);
  state.ends = scoring_ends(scan, tracked.rays, state.params.beams, std::move(state.ends));
  const RefinedPose believed = state.believed(time, now);
  state.judge(time, now, believed);

  tracked.estimate = state.estimate(time, believed);
  if (now) {
    tracked.odom_from_robot = now->odom_from_robot;
    tracked.odometry_epoch = now->epoch;
  }
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
    state.rivals.apply(*revision.map, state.field, revision.field_patch.box);
    state.stability.forget(revision.changes);
  } else {
    state.field = LikelihoodField{*revision.map, state.params.field};
    state.forget_differences(*revision.map);
    state.rivals.apply(*revision.map, state.field, {{0, 0}, {revision.map->width(), revision.map->height()}});
  }
  state.map = revision.map;
  state.revision = revision.number;
}

void Localizer::relocalize(const InitialPose& pose) { state_->start_around(pose); }

StabilityRecord Localizer::stability() const { return state_->stability.record(); }

bool Localizer::restore(const StabilityRecord& record) { return state_->stability.restore(record); }

FieldPatch prepared_field_patch(const LocalizerParams& params, const OccupancyGrid& map,
                                std::span<const CellChange> changes) {
  return field_patch(map, changes, params.field);
}

}  // namespace deltamap::localization
