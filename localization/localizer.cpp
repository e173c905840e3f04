// SPDX-License-Identifier: Apache-2.0
#include "localization/localizer.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "localization/last_update.hpp"
#include "localization/localizer_params.hpp"
#include "localization/weighing.hpp"

namespace deltamap::localization {
namespace {

constexpr std::uint64_t kSeedOfRivals = 0x52697661;
constexpr double kTrustAtStart = 0.9;    // P(pose right) at a pose that a person gave,
constexpr double kTrustInASearch = 0.5;  // at one that a search has found,
constexpr double kTrustInNothing = 0.1;  // and before there is any

}  // namespace

struct Localizer::State {
  State(const LocalizerParams& given, std::shared_ptr<const OccupancyGrid> first_map, std::uint64_t seed)
      : params{given},
        map{with_free_space(std::move(first_map))},
        field{*map, given.field},
        odometry{given.odometry},
        filter{given.particles, seed},
        track{given.track, given.motion},
        hypotheses{given.hypothesis},
        monitor{given.fit},
        judgement{*map, given.judgement},
        rivals{given.rivals, given.places, given.global, *map, field, seed ^ kSeedOfRivals} {}

  LocalizerParams params;
  std::shared_ptr<const OccupancyGrid> map;
  std::uint32_t revision = 0;
  LikelihoodField field;
  std::optional<BeamModel> beam_model;  ///< only where it is chosen
  Point2 robot_from_laser{0.0, 0.0};
  OdometryBuffer odometry;
  ParticleFilter filter;
  PoseTrack track;
  HypothesisFinder hypotheses;
  FitMonitor monitor;
  Judgement judgement;
  Rivals rivals;
  PoseCheck check;  ///< under way: particles around a pose that is not yet believed
  LocalizerCounts counts;
  Hypothesis best;
  BeamEnds ends;
  BeamErrors errors;
  std::optional<LastUpdate> last_update;
  std::optional<Timestamp> last_scan;
  std::optional<std::uint32_t> last_epoch;
  bool drawn_anew = false;  ///< the particles, so that `hypotheses` must look at them again
  Pose2 last_joined;        ///< odometry at the last scan
  double w_avg = 1.0;       ///< before any scan nothing speaks against the pose

  void start_at(const InitialPose& given) {
    const Start start = usable_start(*map, given);
    counts.poses_in_obstacle += start.kind == StartKind::kCheck && !given.remembered ? 1 : 0;
    counts.poses_refused += start.kind == StartKind::kAnywhere ? 1 : 0;
    if (start.kind == StartKind::kAnywhere) return start_anywhere();
    start_around(start.pose);
    rivals.start_believing();
    last_update.reset();
    if (start.kind == StartKind::kCheck) check_pose();
  }

  void start_around(const InitialPose& pose) {
    filter.start_around(pose.map_from_robot, pose.position_deviation_m, pose.heading_deviation_rad);
    best = hypotheses.best(filter.particles());
    monitor.start(LocalizerState::kTracking);
    track.forget();
    judgement.start(kTrustAtStart);
    check.end();
  }

  /// The particles stay where they are, but must prove themselves.
  void check_pose() {
    monitor.start(LocalizerState::kGlobal);
    check.start();
  }

  void start_anywhere() {
    ++counts.searches;
    check.end();
    rivals.start_anywhere();
    judgement.start(kTrustInNothing);
    best = anywhere_in(*map);
    monitor.start(LocalizerState::kGlobal);
    track.forget();
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
  void believe_in(const Pose2& place) {
    start_around({place, params.fit.converged_m / 2.0, params.fit.converged_rad / 2.0});
    if (!rivals.is_near_believed(place)) judgement.start(kTrustInASearch, true);
    rivals.start_believing_in(place);
    last_update->believed = {best.map_from_robot, best.covariance};
  }

  /// A place that holds nearly all belief, for long enough, and that the map explains now.
  [[nodiscard]] bool has_won(const RivalPlace& place) const {
    return place.share >= params.rivals.winning_share && place.followed_m >= params.rivals.wins_after_m &&
           ends.size() > 0 && explained_share(field, ends, place.map_from_robot) >= params.fit.found_above;
  }

  [[nodiscard]] bool is_nearby(const Pose2& place, const Pose2& believed) const {
    return distance_between(place, believed) < params.rivals.nearby_m;
  }

  /// The robot is not where it was believed to be; before another place is believed, the whole map is searched.
  RefinedPose doubt(const RefinedPose& believed) {
    ++counts.searches;
    rivals.stop_believing();
    judgement.start(kTrustInNothing);
    monitor.start(LocalizerState::kGlobal);
    return believed;
  }

  [[nodiscard]] MotionSince motion_since_update(Timestamp time, const std::optional<OdometryAt>& now) const {
    return last_update ? motion_since(*last_update, time, now, params.update.time_s) : MotionSince{};
  }

  [[nodiscard]] bool update_due(const MotionSince& since) const {
    return !last_update || since.motion.position().norm() >= params.update.distance_m ||
           std::abs(since.motion.theta) >= params.update.turn_rad || since.passed_s >= params.update.time_s;
  }

  [[nodiscard]] double beam_share() const {
    return std::min(1.0, params.particles.evidence_beams / static_cast<double>(ends.size()));
  }

  [[nodiscard]] std::int32_t misfit_at(const Pose2& map_from_robot) const {
    return beam_model ? beam_model->misfit_steps(ends, robot_from_laser, map_from_robot)
                      : misfit_steps(field, ends, map_from_robot);
  }

  [[nodiscard]] std::span<const std::int32_t> weighed() {
    if (!beam_model) return filter.weigh(field, ends, params.particles.evidence_beams);
    return filter.weigh_by([&](const Pose2& pose) { return misfit_at(pose); }, ends.size(),
                           params.particles.evidence_beams);
  }

  /// The beam model knows the range that counts as none only from the scans.
  void make_beam_model(const Scan& scan) {
    robot_from_laser = scan.robot_from_laser.position();
    if (params.model == ScanModel::kBeam && !beam_model) beam_model.emplace(*map, params.beam_model, scan.max_range_m);
  }

  /// Moves and weighs the particles; they may be drawn anew afterwards.
  RefinedPose update(Timestamp time, const std::optional<OdometryAt>& now, const MotionSince& since) {
    if (last_update) filter.move(since.motion, since.unknown_s, track.particle_motion());
    std::span<const std::int32_t> misfits;
    if (ends.size() > 0) misfits = weighed();
    const double n_eff = filter.n_eff();
    best = hypotheses.best(filter.particles());
    RefinedPose believed = track.before_scan(time, now, best);
    if (ends.size() > 0) {
      w_avg = mean_over_members(misfits);
      believed = slid(believed);
      const std::size_t before = filter.particles().size();
      const bool drawn = filter.resample_if_needed(hypotheses.cell_count());
      // Where all belonged to the best hypothesis, all that were drawn from them do.
      drawn_anew = drawn && (hypotheses.members().size() != before || filter.particles().size() != before);
    }
    last_update = LastUpdate{time, now, believed, n_eff};
    return believed;
  }

  /// The pose where the scan fits best.
  RefinedPose slid(const RefinedPose& prior) {
    const Refinement found = refined(field, ends, prior, best.covariance, errors, beam_share(), params.refinement);
    errors = found.errors;
    return found.pose;
  }

  [[nodiscard]] double mean_over_members(std::span<const std::int32_t> misfits) const {
    double sum = 0.0;
    for (const std::uint32_t i : hypotheses.members()) sum += mean_likelihood(misfits[i], ends.size());
    return sum / static_cast<double>(hypotheses.members().size());
  }

  /// Between updates: the particles stay, the answer follows the wheels and the scan.
  RefinedPose follow(Timestamp time, const std::optional<OdometryAt>& now, const MotionSince& since) {
    Hypothesis moved = best;
    moved.map_from_robot = best.map_from_robot * since.motion;
    const RefinedPose prior = track.before_scan(time, now, moved);
    if (ends.size() == 0) return prior;
    if (drawn_anew) best.weight = hypotheses.best(filter.particles()).weight;
    drawn_anew = false;
    w_avg = mean_over_some_members(since.motion);
    return slid(prior);
  }

  /// Evenly chosen: enough to know the mean over all of them.
  [[nodiscard]] double mean_over_some_members(const Pose2& motion) const {
    constexpr std::size_t kEnough = 50;
    const std::span<const std::uint32_t> members = hypotheses.members();
    const std::size_t count = std::min(kEnough, members.size());
    double sum = 0.0;
    for (std::size_t nth = 0; nth < count; ++nth) {
      const Pose2 standing = filter.particles().pose(members[nth * members.size() / count]);
      sum += mean_likelihood(misfit_at(standing * motion), ends.size());
    }
    return sum / static_cast<double>(count);
  }

  /// Before the scan is used: what is wrong with it, or with the time since the last one.
  void note_oddities(Timestamp time, const std::optional<OdometryAt>& now) {
    ++counts.scans;
    counts.scans_without_return += ends.size() == 0 ? 1 : 0;
    counts.scans_without_odometry += now ? 0 : 1;
    counts.odometry_epochs += now && last_epoch && now->epoch != *last_epoch ? 1 : 0;
    if (now) last_epoch = now->epoch;
    if (!last_scan) return;
    const double passed_s = seconds(time - *last_scan);
    if (passed_s < 0.0) {
      ++counts.clock_fell_back;
      if (last_update) last_update->time = time;
    }
    if (passed_s < params.gap_s || monitor.state() != LocalizerState::kTracking) return;
    ++counts.gaps;
    check_pose();
  }

  RefinedPose believed(Timestamp time, const std::optional<OdometryAt>& now) {
    if (monitor.state() == LocalizerState::kGlobal && !check.under_way()) return search(time, now);
    const MotionSince since = motion_since_update(time, now);
    const RefinedPose believed = update_due(since) ? update(time, now, since) : follow(time, now, since);
    track.after_scan(time, now, believed);
    const bool lost = monitor.state() == LocalizerState::kLost;
    const RivalReport& report =
        rivals.observe(field, {.ends = ends,
                               .joined_from_robot = now ? now->joined_from_robot : last_joined,
                               .map_from_believed = lost ? std::nullopt : std::optional{believed.map_from_robot},
                               .unknown_s = since.unknown_s});
    if (report.listed == 0 || !has_won(report.rivals.front())) return believed;
    if (!lost && !is_nearby(report.rivals.front().map_from_robot, believed.map_from_robot)) return doubt(believed);
    ++counts.recoveries;
    last_update->time = time;
    last_update->odometry = now;
    believe_in(report.rivals.front().map_from_robot);
    return last_update->believed;
  }

  void judge(const Scan& scan, std::span<const RayInRobot> rays, const std::optional<OdometryAt>& now,
             const RefinedPose& believed) {
    FitMonitor::Observation seen;
    if (last_scan) seen.passed_s = std::max(0.0, seconds(scan.time - *last_scan));
    if (now && last_scan) {
      const Pose2 motion = motion_between(last_joined, now->joined_from_robot);
      seen.driven_m = motion.position().norm();
      seen.turned_rad = std::abs(motion.theta);
    }
    if (now) last_joined = now->joined_from_robot;
    last_scan = scan.time;
    if (ends.size() == 0) return;  // a scan that saw nothing says nothing
    seen.fit = explained_share(field, ends, believed.map_from_robot);
    if (check.under_way()) return judge_start(seen.fit);
    const LocalizerState before = monitor.state();
    const Belief& belief = judgement.observe({.map = *map,
                                              .scan = scan,
                                              .rays = rays,
                                              .believed = believed,
                                              .state = before,
                                              .passed = {seen.driven_m, seen.turned_rad, seen.passed_s},
                                              .rivals = rivals.report()});
    seen.verdict = belief.verdict;
    seen.trust = judgement.trust();
    seen.beaten = rivals.report().beaten;
    const LocalizerState after = monitor.observe(seen, best);
    rivals.suspect(monitor.suspicious());
    if (monitor.search_failed()) {
      ++counts.searches_failed;
      start_anywhere();
    }
    if (before == after) return;
    if (after == LocalizerState::kLost) rivals.stop_believing();
    if (before == LocalizerState::kLost && after == LocalizerState::kTracking) {
      rivals.start_believing_in(believed.map_from_robot);
    }
    if (before == LocalizerState::kLost && after == LocalizerState::kGlobal) ++counts.searches;
    if (before == LocalizerState::kGlobal && after == LocalizerState::kTracking) believe_in(believed.map_from_robot);
  }

  void judge_start(double fit) {
    const PoseCheck::Answer answer = check.observe(fit, params.fit.found_above);
    counts.poses_confirmed += answer == PoseCheck::Answer::kFits ? 1 : 0;
    counts.poses_refuted += answer == PoseCheck::Answer::kDoesNotFit ? 1 : 0;
    if (answer == PoseCheck::Answer::kFits) monitor.start(LocalizerState::kTracking);
    if (answer == PoseCheck::Answer::kDoesNotFit) start_anywhere();
  }

  [[nodiscard]] Estimate estimate(Timestamp time, const RefinedPose& believed) const {
    return {.time = time,
            .map_from_robot = believed.map_from_robot,
            .covariance = believed.covariance,
            .state = monitor.state(),
            .n_eff = last_update->n_eff,
            .particles = static_cast<std::uint32_t>(
                monitor.state() == LocalizerState::kGlobal ? rivals.report().places : filter.particles().size()),
            .belief = judgement.belief(),
            .w_avg = w_avg,
            .revision = revision,
            .map = map};
  }
};

Localizer::Localizer(const LocalizerParams& params, std::shared_ptr<const OccupancyGrid> map,
                     std::optional<InitialPose> initial_pose, std::uint64_t seed)
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

void Localizer::observe(const Odometry& odometry) { state_->odometry.add(odometry); }

TrackedScan Localizer::observe(Scan scan) {
  State& state = *state_;
  TrackedScan tracked;
  const Timestamp time = scan.time;
  const std::optional<OdometryAt> now = state.odometry.at(time);
  const BodyVelocity velocity = state.odometry.velocity_at(time);
  tracked.rays = deskewed(scan, velocity);
  state.make_beam_model(scan);
  state.ends = scoring_ends(scan, tracked.rays, state.params.beams, std::move(state.ends));
  state.note_oddities(time, now);
  const RefinedPose believed = state.believed(time, now);
  state.judge(scan, tracked.rays, now, believed);

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
    state.judgement.forget(revision.changes);
  } else {
    state.field = LikelihoodField{*revision.map, state.params.field};
    state.judgement.forget(*state.map, *revision.map);
    state.rivals.apply(*revision.map, state.field, {{0, 0}, {revision.map->width(), revision.map->height()}});
  }
  state.map = revision.map;
  state.revision = revision.number;
  state.beam_model.reset();
}

void Localizer::relocalize(const InitialPose& pose) { state_->start_at(pose); }

const RivalReport& Localizer::rivals() const { return state_->rivals.report(); }

const LocalizerCounts& Localizer::counts() const { return state_->counts; }

StabilityRecord Localizer::stability() const { return state_->judgement.stability().record(); }

bool Localizer::restore(const StabilityRecord& record) { return state_->judgement.restore(record); }

FieldPatch prepared_field_patch(const LocalizerParams& params, const OccupancyGrid& map,
                                std::span<const CellChange> changes) {
  return field_patch(map, changes, params.field);
}

}  // namespace deltamap::localization
