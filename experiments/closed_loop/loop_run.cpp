// SPDX-License-Identifier: Apache-2.0
#include "experiments/closed_loop/loop_run.hpp"

#include <algorithm>
#include <cmath>
#include <deque>

#include "experiments/closed_loop/virtual_daemon.hpp"
#include "simulation/scenario/start_map.hpp"

namespace deltamap::experiments {
namespace {

constexpr Timestamp kLoopStart = timestamp_from_ns(1'700'000'000'000'000'000);
constexpr double kOwnSpeedMPerS = 0.02;  // slower it was carried, or touched by somebody
constexpr double kRightM = 0.3;
constexpr double kLookEveryS = 0.05;
constexpr double kLatestS = 2.0;  // an estimate is no older
constexpr double kMapResolutionM = 0.05;

/// What is looked at while time passes.
class LoopWatch {
 public:
  LoopWatch(const simulation::Simulation& world, const VirtualDaemon& daemon, bool has_map)
      : world_{world}, daemon_{daemon}, has_map_{has_map}, last_pose_{world.map_from_robot()} {}

  void count_from(Timestamp begin) {
    begin_ = begin;
    outcome_.driven_before_m = outcome_.moved_m;
    outcome_.moved_m = 0.0;
    outcome_.stopped_after_s = -1.0;
    outcome_.stops.clear();
    first_collision_ = world_.collisions().size();
    first_line_ = daemon_.log().size();
  }

  void look(Timestamp end) {
    const Timestamp now = world_.now();
    if (seconds(now - looked_) < kLookEveryS) return;
    looked_ = now;
    const Pose2 pose = world_.map_from_robot();
    outcome_.moved_m += distance_between(last_pose_, pose);
    last_pose_ = pose;
    truth_.emplace_back(now, pose);
    if (seconds(now - truth_.front().first) > kLatestS) truth_.pop_front();
    const navigation::AllowedMotion allowed = daemon_.last_allowed();
    if (allowed.speed_m_per_s > 0.0) outcome_.stopped_after_s = seconds(now - begin_);
    if (seconds(end - now) <= 10.0) {
      ++last_looks_;
      may_drive_ += daemon_.may_drive_by_pose() ? 1 : 0;
    }
    if (allowed.stop != reason_ && is_told(allowed.stop) && is_right())
      ++outcome_.stops[std::string(name_of(allowed.stop))];
    reason_ = allowed.stop;
  }

  [[nodiscard]] LoopOutcome outcome() {
    outcome_.reason = reason_;
    outcome_.pose_off_m = off_m();
    outcome_.may_drive_at_end_share = last_looks_ > 0 ? static_cast<double>(may_drive_) / last_looks_ : 0.0;
    for (std::size_t i = first_collision_; i < world_.collisions().size(); ++i) {
      const double speed = std::abs(world_.collisions()[i].speed_m_per_s);
      if (speed < kOwnSpeedMPerS) continue;
      ++outcome_.collisions;
      outcome_.fastest_collision_m_per_s = std::max(outcome_.fastest_collision_m_per_s, speed);
    }
    for (std::size_t i = first_line_; i < daemon_.log().size() && outcome_.told.empty(); ++i) {
      if (daemon_.log()[i].starts_with("driving stops")) outcome_.told = daemon_.log()[i];
    }
    return outcome_;
  }

 private:
  [[nodiscard]] double off_m() const {
    const std::optional<Estimate>& estimate = daemon_.estimate();
    if (!estimate || truth_.empty()) return 0.0;
    const auto then = std::find_if(truth_.begin(), truth_.end() - 1,
                                   [&](const auto& truth) { return truth.first >= estimate->time; });
    return distance_between(estimate->map_from_robot, then->second);
  }
  [[nodiscard]] bool is_right() const { return !has_map_ || off_m() < kRightM; }

  const simulation::Simulation& world_;
  const VirtualDaemon& daemon_;
  bool has_map_;
  Pose2 last_pose_;
  std::deque<std::pair<Timestamp, Pose2>> truth_;  // of the last seconds
  Timestamp begin_{};
  Timestamp looked_{};
  std::size_t first_collision_ = 0;
  std::size_t first_line_ = 0;
  int last_looks_ = 0;
  int may_drive_ = 0;
  navigation::StopReason reason_ = navigation::StopReason::kNone;
  LoopOutcome outcome_;
};

/// Full speed ahead, and a turn now and then.
std::function<DriveCommand(const Scan&)> wild(std::uint64_t seed) {
  return [random = Random{seed}, held = DriveCommand{}, until = Timestamp{}](const Scan& scan) mutable {
    if (scan.time > until) {
      held.speed_m_per_s = random.uniform(0.3, 0.7);
      held.turn_rate_rad_per_s = random.uniform() < 0.5 ? random.uniform(-0.8, 0.8) : 0.0;
      until = scan.time + duration_from_seconds(random.uniform(0.5, 4.0));
    }
    held.time = scan.time;
    return held;
  };
}

}  // namespace

daemon::Settings fitting(const simulation::Scenario& scenario, daemon::Settings settings) {
  settings.initial_pose = scenario.robot.map_from_start;
  settings.robot.session.fast_baud = 38400;
  settings.robot.session.limits.max_speed_m_per_s = 0.7;
  settings.robot.session.limits.max_turn_rate_rad_per_s = radians(80.0);
  drivers::lms200::Lms200Params& laser = settings.laser.session;
  laser.baud = 38400;
  laser.variant = *drivers::lms200::variant_named("180/1");
  laser.max_range_m = scenario.laser.max_range_m;
  laser.robot_from_laser = scenario.laser.optics.robot_from_laser;
  return settings;
}

LoopOutcome outcome_of(const LoopRun& run) {
  simulation::Simulation world{run.scenario, {.seed = run.seed, .start = kLoopStart, .change_every_s = {}}};
  VirtualDaemon::Params params;
  params.settings = run.settings;
  params.settings.seed = run.seed;
  if (run.has_pilot_gone_wild) {
    params.pilot = wild(run.seed);
  } else {
    params.map = std::make_shared<const OccupancyGrid>(simulation::start_map(run.scenario, kMapResolutionM));
  }
  const auto first = params.map;
  VirtualDaemon daemon{world, std::move(params)};
  LoopWatch watch{world, daemon, !run.has_pilot_gone_wild};
  daemon.start();
  daemon.run(kConnectS);
  (void)daemon.operator_says(true);
  const Timestamp begin = world.now() + duration_from_seconds(run.before_s);
  const Timestamp end = begin + duration_from_seconds(run.for_s);
  daemon.run(run.before_s, [&] { watch.look(end); });
  watch.count_from(world.now());
  daemon.run(run.for_s, [&] { watch.look(end); });
  LoopOutcome outcome = watch.outcome();
  if (first == nullptr) return outcome;
  for (const CellChange& change : changes_between(*first, *daemon.map()))
    outcome.walls_freed += change.before == CellState::kOccupied && change.after == CellState::kFree ? 1 : 0;
  return outcome;
}

}  // namespace deltamap::experiments
