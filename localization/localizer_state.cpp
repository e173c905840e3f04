// SPDX-License-Identifier: Apache-2.0
#include "localization/localizer_state.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "localization/sensor/mapped_beams.hpp"
#include "localization/sensor/straight_walk.hpp"
#include "localization/sensor/weighing.hpp"

namespace deltamap::localization {
namespace {

constexpr std::uint64_t kSeedOfHypotheses = 0x52697661;
constexpr double kTrustAtStart = 0.9;    // P(pose right) at a pose that a person gave,
constexpr double kTrustInNothing = 0.1;  // and before there is any; one that a search has found is as right as wrong

constexpr double kScansLagS = 0.5;    // a scan is at most so much older than the newest report of the wheels
constexpr double kScansCeaseS = 5.0;  // without a scan: the particles go along with the wheels, step by step

// Share of the returned beams that the map tells of: with fewer the scans' own motion leads, not the wheels'.
constexpr double kTellsLittle = 0.5;
constexpr double kBlindlyM = 1.0;  // deviation up to which the wheels alone may carry a pose

constexpr double kClearlyBetter = 0.15;  // share of the ends that one hypothesis explains beyond another

// A search has only begun: the whole map has been looked at twice at most.
constexpr double kSearchBeginsM = 1.0;
const double kSearchBeginsRad = radians(90.0);

}  // namespace

Localizer::State::State(const LocalizerParams& given, std::shared_ptr<const OccupancyGrid> first_map,
                        std::uint64_t seed)
    : params{given},
      map{particles::with_free_space(std::move(first_map))},
      field{*map, given.field},
      odometry{given.odometry},
      tracker{given, map, seed},
      monitor{given.fit},
      judgement{*map, given.judgement},
      hypotheses{given.hypothesis_tracker, given.global, *map, field, seed ^ kSeedOfHypotheses} {}

void Localizer::State::start_at(const particles::InitialPose& given) {
  was_found = false;
  judgement.start_on_known_ground();
  const particles::Start start = particles::usable_start(*map, given);
  counts.poses_in_obstacle += start.kind == particles::StartKind::kCheck && !given.remembered ? 1 : 0;
  counts.poses_refused += start.kind == particles::StartKind::kAnywhere ? 1 : 0;
  if (start.kind == particles::StartKind::kAnywhere) return start_anywhere();
  (void)tracker.start_around(start.pose);
  start_tracking();
  hypotheses.start_believing();
  if (start.kind == particles::StartKind::kCheck) check_pose();
}

void Localizer::State::start_tracking() {
  forget_expected();
  given_up.reset();
  monitor.start(LocalizerState::kTracking);
  judgement.start(kTrustAtStart);
  check.end();
}

void Localizer::State::check_pose() {
  forget_expected();
  monitor.start(LocalizerState::kGlobal);
  judgement.start(belief::kAsRightAsWrong);
  check.start();
}

void Localizer::State::start_anywhere() {
  judgement.start_on_known_ground();
  forget_expected();
  given_up.reset();
  ++counts.searches;
  check.end();
  hypotheses.start_anywhere();
  judgement.start(kTrustInNothing);
  best = particles::anywhere_in(*map);
  monitor.start(LocalizerState::kGlobal);
}

sensor::RefinedPose Localizer::State::believe_in(const Pose2& hypothesis, const motion::ScanInstant& now) {
  const particles::InitialPose around{hypothesis, params.fit.converged_m / 2.0, params.fit.converged_rad / 2.0};
  sensor::RefinedPose believed = tracker.start_around(around, now);
  start_tracking();
  if (!hypotheses.is_near_believed(hypothesis)) {
    judgement.start(belief::kAsRightAsWrong);
    was_found = true;
  }
  hypotheses.start_believing_in(hypothesis);
  return believed;
}

void Localizer::State::doubt(const Pose2& map_from_believed, const motion::ScanInstant& now) {
  given_up = GivenUp{map_from_believed, continuous_odom_at(now)};
  check.end();
  ++counts.searches;
  hypotheses.stop_believing();
  judgement.start(kTrustInNothing);
  monitor.start(LocalizerState::kGlobal);
}

void Localizer::State::take(const Odometry& report) {
  odometry.add(report);
  if (last_report) silence_s = std::max(silence_s, seconds(report.time - *last_report));
  last_report = report.time;
  if (!last_scan || searches()) return;
  const Timestamp behind = report.time - duration_from_seconds(kScansLagS);
  if (seconds(behind - *last_scan) < kScansCeaseS) return;
  const motion::ScanInstant now{behind, odometry.at(behind)};
  if (now.odometry && !has_jumped(now)) tracker.predict(now);
}

motion::ScanInstant Localizer::State::witnessed(const Scan& scan, std::span<const RayInRobot> rays) {
  const bool leads = map_tells_little();
  const odometer::LaserMotion seen = witness.observe(scan, rays, odometry, odometry, leads);
  const motion::ScanInstant now{scan.time, odometry.at(scan.time)};
  stood_m = seen.stood_m;
  judgement.carry({.is_continued = covers_the_gap(now),
                   .fits_before = !seen.is_lost && (leads || !seen.contradicts),
                   .driven_m = seen.motion.position().norm()});
  counts.wheels_contradicted += seen.contradicts ? 1 : 0;
  return now;
}

bool Localizer::State::map_tells_little() const {
  return static_cast<double>(ends.size()) < kTellsLittle * static_cast<double>(returned);
}

bool Localizer::State::has_jumped(const motion::ScanInstant& now) const {
  return now.odometry && last_epoch && now.odometry->epoch != *last_epoch;
}

bool Localizer::State::covers_the_gap(const motion::ScanInstant& now) const {
  return now.odometry && !has_jumped(now) && std::max(silence_s, now.odometry->uncovered_s) < params.gap_s;
}

bool Localizer::State::searches() const { return monitor.state() == LocalizerState::kGlobal && !check.under_way(); }

void Localizer::State::note_oddities(const motion::ScanInstant& now) {
  ++counts.scans;
  counts.scans_without_return += ends.size() == 0 ? 1 : 0;
  counts.scans_without_odometry += now.odometry ? 0 : 1;
  counts.odometry_epochs += has_jumped(now) ? 1 : 0;
  const bool is_covered = covers_the_gap(now);
  silence_s = 0.0;
  if (now.odometry) last_epoch = now.odometry->epoch;
  if (!last_scan) return;
  const double passed_s = seconds(now.time - *last_scan);
  if (passed_s < 0.0) {
    ++counts.clock_fell_back;
    tracker.restart_clock(now.time);
  }
  if (passed_s < params.gap_s || is_covered || monitor.state() != LocalizerState::kTracking) return;
  ++counts.gaps;
  check_pose();
}

void Localizer::State::leave_out_unmapped(const Point2& robot_from_laser, const motion::ScanInstant& now) {
  returned = ends.size();
  const std::optional<Pose2> expected = expected_pose(now);
  if (!expected || searches() || was_found || best.covariance.topLeftCorner<2, 2>().trace() > kBlindlyM * kBlindlyM)
    return;
  has_gone_through = has_gone_through || meets_obstacle(last_believed->position(), expected->position());
  has_gone_through = has_gone_through && sensor::explained_share(field, ends, *expected) < params.fit.found_above;
  if (has_gone_through || judgement.belief().fits_worse) return;
  const sensor::MappedBeams mapped{*map, field, {*expected, best.covariance}, robot_from_laser};
  std::size_t mapped_ends = 0;
  while (mapped_ends < ends.size() && mapped.tells({ends.x_m[mapped_ends], ends.y_m[mapped_ends]})) ++mapped_ends;
  if (mapped_ends == ends.size()) return;
  motion::keep_ends(
      ends, [&](const Point2& end) { return mapped.tells_everywhere(end); }, ends);
  faces.keep([mapped](const Point2& end) { return mapped.tells_everywhere(end); });
}

bool Localizer::State::meets_obstacle(const Point2& from, const Point2& to) const {
  const double way_m = (to - from).norm();
  if (way_m == 0.0) return false;
  return sensor::first_met(*map, from, (to - from) / way_m, 0.0, way_m).what == CellState::kOccupied;
}

sensor::RefinedPose Localizer::State::believed(const motion::ScanInstant& now) {
  return searches() ? search(now) : track(now);
}

sensor::RefinedPose Localizer::State::search(const motion::ScanInstant& now) {
  const hypotheses::HypothesisReport& report =
      hypotheses.observe(field, {.ends = ends, .continuous_odom_from_robot = continuous_odom_at(now)});
  if (const std::optional<hypotheses::PoseHypothesis> hypothesis = hypotheses.best_hypothesis()) {
    best = {hypothesis->map_from_robot, hypothesis->covariance, hypothesis->share};
    if (ends.size() > 0) w_avg = sensor::mean_likelihood(field, ends, best.map_from_robot);
  }
  n_eff = report.effective_hypotheses;
  if (given_up) {
    const Pose2 motion = motion_between(given_up->continuous_odom_from_robot, continuous_odom_at(now));
    const bool only_begun = motion.position().norm() < kSearchBeginsM && std::abs(motion.theta) < kSearchBeginsRad;
    if (only_begun) return {given_up->map_from_robot * motion, best.covariance};
    given_up.reset();
  }
  return {best.map_from_robot, best.covariance};
}

sensor::RefinedPose Localizer::State::track(const motion::ScanInstant& now) {
  const auto poses_within = [this](const sensor::RefinedPose& prior) {
    return hypotheses.poses_within(prior, field, ends);
  };
  const tracking::Tracker::Answer tracked = tracker.observe({.now = now,
                                                             .ends = weighing_ends(now),
                                                             .field = field,
                                                             .faces = faces,
                                                             .velocity = velocity,
                                                             .poses_within = poses_within});
  best = tracker.best();
  w_avg = tracked.w_avg.value_or(w_avg);
  n_eff = tracked.n_eff.value_or(n_eff);
  const bool lost = monitor.state() == LocalizerState::kLost;
  if (tracked.looked_around && !lost) judgement.start(belief::kAsRightAsWrong);
  const hypotheses::HypothesisReport& report = hypotheses.observe(
      field, {.ends = ends,
              .continuous_odom_from_robot = continuous_odom_at(now),
              .map_from_believed = lost ? std::nullopt : std::optional{tracked.believed.map_from_robot},
              .stable_support = stable_support.share(),
              .unknown_s = tracked.unknown_s,
              .kidnapped = judgement.belief().fits_worse});
  if (report.listed == 0 || !has_won(report.others.front(), tracked.believed.map_from_robot)) return tracked.believed;
  const Pose2 winner = report.others.front().map_from_robot;
  if (lost || distance_between(winner, tracked.believed.map_from_robot) < hypotheses::kNearbyM) {
    ++counts.recoveries;
    return believe_in(winner, now);
  }
  const double as_well = sensor::explained_share(field, ends, winner) - kClearlyBetter;
  if (const std::optional<Pose2> near = explained_nearby(tracked.believed.map_from_robot, as_well)) {
    ++counts.recoveries;
    return believe_in(*near, now);
  }
  doubt(tracked.believed.map_from_robot, now);
  return tracked.believed;
}

/// Robots slip more often than they are carried away: where the wheels may have slipped to, the scan may fit too.
std::optional<Pose2> Localizer::State::explained_nearby(const Pose2& believed, double share) const {
  const PoseCovariance spread = motion::slip_covariance(params.motion, believed.theta);
  std::optional<Pose2> nearest;
  for (const Pose2& from : motion::slips_around(params.motion, believed)) {
    const Pose2 refined = sensor::refined(field, ends, {from, spread}, 1.0, params.refinement).map_from_robot;
    const double explained = sensor::explained_share(field, ends, refined);
    if (explained < share) continue;
    share = explained;
    nearest = refined;
  }
  return nearest;
}

const motion::BeamEnds& Localizer::State::weighing_ends(const motion::ScanInstant& now) {
  const bool knows = params.temporary.weighing && transients && !transients->standing.empty();
  const std::optional<Pose2> expected = expected_pose(now);
  if (!knows || !expected || ends.size() == 0) return ends;
  ends_beside_transients = sensor::lasting_ends(ends, *transients, *expected, std::move(ends_beside_transients));
  const double left = static_cast<double>(ends_beside_transients.size());
  return left >= params.temporary.least_share_left * static_cast<double>(ends.size()) ? ends_beside_transients : ends;
}

bool Localizer::State::has_won(const hypotheses::ReportedHypothesis& hypothesis, const Pose2& believed) const {
  if (hypothesis.share_around < hypotheses::kWinningShare || hypothesis.followed_m < hypotheses::kWinsAfterM)
    return false;
  if (ends.size() == 0 || judgement.is_fixed()) return false;
  const double fit = sensor::explained_share(field, ends, hypothesis.map_from_robot);
  return fit >= params.fit.found_above || fit >= sensor::explained_share(field, ends, believed) + kClearlyBetter;
}

void Localizer::State::judge(const Scan& scan, std::span<const RayInRobot> rays, const motion::ScanInstant& now,
                             const sensor::RefinedPose& believed) {
  belief::FitMonitor::Observation seen = passed_since_last_scan(now);
  last_odom = continuous_odom_at(now);
  last_scan = now.time;
  const bool is_tracking = monitor.state() == LocalizerState::kTracking && !check.under_way();
  last_believed = is_tracking ? std::optional{believed.map_from_robot} : std::nullopt;
  seen.fit = sensor::explained_share(field, ends, believed.map_from_robot);
  if (is_tracking)
    range_scale.observe(field, ends, scan.robot_from_laser.position(), believed.map_from_robot, seen.driven_m);
  const bool blind = ends.size() == 0;  // says nothing of the pose but that it was not confirmed
  newest_fit = blind ? std::nullopt : std::optional{seen.fit};
  const double explained = blind ? 0.0 : seen.fit * static_cast<double>(ends.size());
  newest_fit_of_all = returned == 0 ? std::nullopt : std::optional{explained / static_cast<double>(returned)};
  judgement.fix_by_surfaces(!searches() && tracker.is_fixed_by_surfaces());
  judgement.follow({.scan = scan,
                    .rays = rays,
                    .odom_from_robot = last_odom,
                    .odometry_epoch = last_epoch.value_or(0),
                    .map_from_robot = believed.map_from_robot},
                   is_tracking);
  if (check.under_way()) return blind ? void() : judge_start(seen.fit);
  const LocalizerState before = monitor.state();
  judgement.observe({.map = *map,
                     .scan = scan,
                     .rays = rays,
                     .believed = believed,
                     .state = before,
                     .passed = {seen.driven_m, seen.turned_rad, seen.passed_s},
                     .hypotheses = hypotheses.report(),
                     .fits = seen.fit >= params.fit.found_above});
  if (before == LocalizerState::kTracking) {
    stable_support.observe(judgement.belief().stable);
  } else {
    stable_support.forget();
  }
  if (blind) return;
  seen.verdict = judgement.belief().verdict;
  seen.trust = judgement.trust();
  seen.beaten = hypotheses.report().beaten;
  seen.is_held = judgement.is_held();
  const LocalizerState after = monitor.observe(seen, best);
  hypotheses.suspect(monitor.suspicious());
  if (before != after) enter(after, before, believed.map_from_robot, now);
}

belief::FitMonitor::Observation Localizer::State::passed_since_last_scan(const motion::ScanInstant& now) const {
  if (!last_scan) return {};
  belief::FitMonitor::Observation seen{.passed_s = std::max(0.0, seconds(now.time - *last_scan))};
  const Pose2 motion = motion_between(last_odom, continuous_odom_at(now));
  seen.driven_m = motion.position().norm();
  seen.turned_rad = std::abs(motion.theta);
  return seen;
}

void Localizer::State::judge_start(double fit) {
  const particles::PoseCheck::Answer answer = check.observe(fit, params.fit.found_above);
  counts.poses_confirmed += answer == particles::PoseCheck::Answer::kFits ? 1 : 0;
  counts.poses_refuted += answer == particles::PoseCheck::Answer::kDoesNotFit ? 1 : 0;
  if (answer == particles::PoseCheck::Answer::kFits) monitor.start(LocalizerState::kTracking);
  if (answer == particles::PoseCheck::Answer::kDoesNotFit) start_anywhere();
}

void Localizer::State::enter(LocalizerState after, LocalizerState before, const Pose2& believed,
                             const motion::ScanInstant& now) {
  if (after == LocalizerState::kLost) hypotheses.stop_believing();
  if (before == LocalizerState::kLost && after == LocalizerState::kTracking) hypotheses.start_believing_in(believed);
  if (before == LocalizerState::kLost && after == LocalizerState::kGlobal) {
    ++counts.searches;
    given_up = GivenUp{believed, continuous_odom_at(now)};
  }
  if (before == LocalizerState::kGlobal && after == LocalizerState::kTracking) (void)believe_in(believed, now);
}

Pose2 Localizer::State::continuous_odom_at(const motion::ScanInstant& now) const {
  return now.odometry ? now.odometry->continuous_odom_from_robot : last_odom;
}

std::optional<Pose2> Localizer::State::expected_pose(const motion::ScanInstant& now) const {
  if (!last_believed) return std::nullopt;
  return *last_believed * motion_between(last_odom, continuous_odom_at(now));
}

Estimate Localizer::State::estimate(Timestamp time, const sensor::RefinedPose& believed) const {
  const tracking::Tracker::NotCounted more = tracker.not_counted_in(believed);
  return {.time = time,
          .map_from_robot = believed.map_from_robot,
          .covariance = believed.covariance + more.noise + more.bias,
          .bias_covariance = more.bias,
          .state = monitor.state(),
          .checks_pose = check.under_way(),
          .relocalizations = static_cast<std::uint32_t>(counts.relocalizations),
          .n_eff = n_eff,
          .particles = static_cast<std::uint32_t>(
              monitor.state() == LocalizerState::kGlobal ? hypotheses.report().followed : tracker.particle_count()),
          .belief = judgement.belief(),
          .w_avg = w_avg,
          .revision = revision,
          .map = map};
}

}  // namespace deltamap::localization
