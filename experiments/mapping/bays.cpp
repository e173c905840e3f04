// SPDX-License-Identifier: Apache-2.0
// `bays`: what is told of bays, held against what stands there. `seen`: loads come and go behind the robot's back, and
// the whole of localizer, mapping and bays follows; `people`: nothing changes for hours, and ten people walk about.
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

#include "daemon/replay/sequential_run.hpp"
#include "daemon/telemetry/stage.hpp"
#include "experiments/pooled_runs.hpp"
#include "experiments/registry.hpp"
#include "experiments/seed_summary.hpp"
#include "experiments/watch/bay_yard.hpp"
#include "mapping/bays/bays.hpp"
#include "simulation/movers/person.hpp"
#include "simulation/scenario/start_map.hpp"

namespace deltamap::experiments {
namespace {

using mapping::bays::BayState;
using mapping::bays::BayStatus;

constexpr double kBayScan_s = 0.2133;  // 38400 baud, 181 values
constexpr double kInView = 0.6;        // of the beams that lead to it
constexpr double kSoon_s = 3.0;
constexpr double kSurely_s = 10.0;
constexpr double kChangeEvery_s = 15.0;
constexpr double kUnseenBeyond_m = 11.0;  // loads come and go where the robot does not look
constexpr double kSeenMinutes = 30.0;
constexpr double kPeopleHours = 6.25;  // of 24 bays: 150 bay-hours
constexpr int kPeople = 10;
constexpr double kStandsFor_s = 90.0;  // the robot, between two places
constexpr Timestamp kBegins = timestamp_from_ns(1'700'000'000'000'000'000);

/// Along straight lines at 0.5 m/s, turning on the spot at 40°/s, round and round.
class RoundTrip {
 public:
  explicit RoundTrip(std::vector<Point2> corners) : corners_{std::move(corners)} {
    const Point2 first = corners_[1] - corners_[0];
    pose_ = {corners_[0].x(), corners_[0].y(), std::atan2(first.y(), first.x())};
  }
  [[nodiscard]] const Pose2& pose() const { return pose_; }
  /// The motion of this step.
  Pose2 step(double dt_s) {
    const Point2 way = corners_[aim_] - pose_.position();
    const double off_rad = turn_between(pose_.theta, std::atan2(way.y(), way.x()));
    const double most_rad = radians(40.0) * dt_s;
    const double forward_m = std::abs(off_rad) > 0.1 ? 0.0 : std::min(way.norm(), 0.5 * dt_s);
    const Pose2 motion{forward_m, 0.0, std::clamp(off_rad, -most_rad, most_rad)};
    pose_ = pose_ * motion;
    if ((corners_[aim_] - pose_.position()).norm() < 0.05) aim_ = (aim_ + 1) % corners_.size();
    return motion;
  }

 private:
  std::vector<Point2> corners_;
  std::size_t aim_ = 1;
  Pose2 pose_;
};

/// What became of one bay since its load changed.
struct BayCourse {
  std::vector<std::pair<Timestamp, BayState>> truths;  // since when
  double seen_s = 0.0;
  bool was_reached = false;  // by any beam, ever

  [[nodiscard]] BayState truth_at(Timestamp time) const {
    BayState state = truths.front().second;
    for (const auto& [since, truth] : truths) {
      if (since <= time) state = truth;
    }
    return state;
  }
};

struct BayTally {
  int soon = 0, soon_right = 0;
  int surely = 0, surely_told = 0, surely_right = 0;
  int states = 0, not_so_when_seen = 0, never_looked = 0;
};

class SeenRun {
 public:
  SeenRun(const daemon::Settings& settings, std::uint64_t seed)
      : yard_{seed}, random_{seed + 1000}, trip_{BayYard::way()} {
    daemon::Settings own = settings;
    own.initial_pose = trip_.pose();
    daemon::StartMap start;
    start.map =
        std::make_shared<const OccupancyGrid>(simulation::start_map(yard_.world(), trip_.pose().position(), 0.05));
    start.site = std::make_shared<const daemon::Site>(daemon::Site{yard_.bays(), {}});
    run_.emplace(own, start, nullptr, 1.0);
    courses_.resize(yard_.bays().size());
    for (std::size_t i = 0; i < courses_.size(); ++i) courses_[i].truths.emplace_back(kBegins, yard_.truth(i));
  }

  BayTally drive(double for_s) {
    double next_change_s = kChangeEvery_s;
    double next_sample_s = 1.0;
    const auto scans = static_cast<int>(std::ceil(for_s / kBayScan_s));
    for (int number = 0; number < scans; ++number) {
      const double time_s = number * kBayScan_s;
      if (time_s >= next_change_s) {
        change(time_s);
        next_change_s += kChangeEvery_s;
      }
      scan(time_s);
      if (time_s < next_sample_s) continue;
      next_sample_s += 1.0;
      sample();
    }
    return tally_;
  }

 private:
  void change(double time_s) {
    for (int tries = 0; tries < 20; ++tries) {
      const std::size_t bay = random_.index_below(static_cast<std::uint32_t>(courses_.size()));
      const Point2 middle = 0.5 * (yard_.bays()[bay].polygon[0] + yard_.bays()[bay].polygon[2]);
      if ((middle - trip_.pose().position()).norm() < kUnseenBeyond_m) continue;
      yard_.change(bay);
      courses_[bay].truths.emplace_back(kBegins + duration_from_seconds(time_s), yard_.truth(bay));
      courses_[bay].seen_s = 0.0;
      return;
    }
  }

  void scan(double time_s) {
    const Pose2 motion = trip_.step(kBayScan_s);
    wheels_ = wheels_ * Pose2{motion.x * (1.01 + random_.normal(0.01)), 0.0,
                              motion.theta * (1.0 + random_.normal(0.01)) + random_.normal(0.001)};
    Odometry odometry;
    odometry.time = kBegins + duration_from_seconds(time_s);
    odometry.odom_from_robot = wheels_;
    run_->observe(odometry);
    const std::vector<double> ranges = yard_.ranges(trip_.pose(), {});
    Scan scan = scan_of(ranges, odometry.time, random_);
    scan.number = number_++;
    run_->take_what_is_due(scan);
    const TrackedScan tracked = run_->observe(std::move(scan));
    if (const auto request = run_->look_for_changes(tracked)) (void)run_->update_map(*request);
    for (std::size_t i = 0; i < courses_.size(); ++i) look(i, ranges);
  }

  void look(std::size_t bay, const std::vector<double>& ranges) {
    BayCourse& course = courses_[bay];
    const double view = yard_.view_of(bay, trip_.pose(), ranges);
    course.was_reached = course.was_reached || yard_.is_reached(bay, trip_.pose(), ranges);
    if (view < kInView) return;
    const double before_s = course.seen_s;
    course.seen_s += kBayScan_s;
    const auto passes = [&](double limit_s) { return before_s < limit_s && course.seen_s >= limit_s; };
    const BayStatus status = run_->bays().list()->statuses[bay];
    const bool is_right = status.state == yard_.truth(bay);
    if (passes(kSoon_s)) {
      ++tally_.soon;
      tally_.soon_right += is_right ? 1 : 0;
    }
    if (!passes(kSurely_s)) return;
    ++tally_.surely;
    tally_.surely_told += status.state == BayState::kUnknown ? 0 : 1;
    tally_.surely_right += is_right ? 1 : 0;
  }

  void sample() {
    const auto list = run_->bays().list();
    for (std::size_t i = 0; i < courses_.size(); ++i) {
      const BayStatus& status = list->statuses[i];
      if (status.state == BayState::kUnknown) continue;
      ++tally_.states;
      tally_.never_looked += courses_[i].was_reached ? 0 : 1;
      tally_.not_so_when_seen += courses_[i].truth_at(*status.seen) == status.state ? 0 : 1;
    }
  }

  BayYard yard_;
  Random random_;
  RoundTrip trip_;
  Pose2 wheels_;
  std::optional<daemon::SequentialRun> run_;
  std::vector<BayCourse> courses_;
  BayTally tally_;
  std::uint32_t number_ = 0;
};

Outcome seen_outcome(const daemon::Settings& settings, double minutes, std::uint64_t seed) {
  const BayTally tally = SeenRun{settings, seed}.drive(60.0 * minutes);
  Outcome outcome;
  outcome.labels = {{"part", "seen"}, {"seed", std::to_string(seed)}};
  const auto add = [&](const char* name, int count) { outcome.numbers.emplace_back(name, static_cast<double>(count)); };
  add("seen_3s", tally.soon);
  add("right_3s", tally.soon_right);
  add("seen_10s", tally.surely);
  add("told_10s", tally.surely_told);
  add("right_10s", tally.surely_right);
  add("states", tally.states);
  add("not_so_when_seen", tally.not_so_when_seen);
  add("never_looked", tally.never_looked);
  return outcome;
}

/// They come into the yard along an aisle: nobody begins where loads shut him in.
void begin_in_aisle(const BayYard& yard, std::vector<Point2>& path) {
  const auto aisle = std::find_if(path.begin(), path.end(), [&](const Point2& corner) {
    return std::none_of(yard.bays().begin(), yard.bays().end(),
                        [&](const auto& bay) { return contains(bay.polygon, corner); });
  });
  if (aisle != path.end()) std::rotate(path.begin(), aisle, path.end());
}

std::vector<simulation::Person> people_in(const BayYard& yard, Random& random) {
  std::vector<simulation::Person> people;
  for (int i = 0; i < kPeople; ++i) {
    simulation::PersonParams params;
    for (int corner = 0; corner < 12; ++corner) params.path.push_back(yard.floor(random));
    begin_in_aisle(yard, params.path);
    params.closed = true;
    params.speed_m_per_s = random.uniform(0.6, 1.5);
    params.radius_m = random.uniform(0.15, 0.25);
    people.emplace_back(std::move(params), Random{random()});
  }
  return people;
}

Pose2 place_on_way(Random& random) {
  const double y_m = random.uniform() < 0.5 ? 2.0 : 11.4;
  return {random.uniform(2.5, 26.0), y_m, random.uniform(-3.14, 3.14)};
}

TrackedScan tracked_at(const Pose2& map_from_robot, Scan scan, Random& random) {
  TrackedScan tracked;
  tracked.estimate.state = LocalizerState::kTracking;
  tracked.estimate.map_from_robot = {map_from_robot.x + random.normal(0.02), map_from_robot.y + random.normal(0.02),
                                     wrapped_angle(map_from_robot.theta + random.normal(radians(0.2)))};
  for (std::size_t i = 0; i < scan.beams.size(); ++i) {
    RayInRobot ray;
    const double bearing_rad = scan.bearing_rad(i);
    ray.end = scan.beams[i].range_m * Eigen::Vector2d{std::cos(bearing_rad), std::sin(bearing_rad)}.cast<float>();
    tracked.rays.push_back(ray);
  }
  tracked.scan = std::move(scan);
  return tracked;
}

Outcome people_outcome(double hours, std::uint64_t seed) {
  BayYard yard{seed};
  Random random{seed + 2000};
  std::vector<simulation::Person> people = people_in(yard, random);
  mapping::bays::Bays bays{yard.bays()};
  Pose2 robot = place_on_way(random);
  int flips = 0;
  int wrong_first = 0;
  double cpu_s = 0.0;
  double in_view_s = 0.0;
  const auto scans = static_cast<std::int64_t>(3600.0 * hours / kBayScan_s);
  for (std::int64_t i = 0; i < scans; ++i) {
    const double time_s = static_cast<double>(i) * kBayScan_s;
    if (std::fmod(time_s, kStandsFor_s) < kBayScan_s) robot = place_on_way(random);
    std::vector<simulation::Circle> bodies;
    for (simulation::Person& person : people) {
      person.move(kBayScan_s, yard.caster(), {robot.position(), 0.3});
      bodies.push_back(person.body());
    }
    const std::vector<double> ranges = yard.ranges(robot, {.round = bodies});
    if (i % 25 == 0) {
      for (std::size_t bay = 0; bay < yard.bays().size(); ++bay)
        in_view_s += yard.view_of(bay, robot, ranges) >= kInView ? 25.0 * kBayScan_s : 0.0;
    }
    const TrackedScan tracked =
        tracked_at(robot, scan_of(ranges, kBegins + duration_from_seconds(time_s), random), random);
    const double began_s = i % 50 == 0 ? daemon::thread_cpu_s() : 0.0;
    const auto events = bays.observe(tracked, true);
    if (i % 50 == 0) cpu_s += daemon::thread_cpu_s() - began_s;
    for (const auto& event : events) {
      if (event.before != BayState::kUnknown) ++flips;
      const auto bay = static_cast<std::size_t>(std::stoul(event.bay.id)) - 1;
      if (event.before == BayState::kUnknown && event.status.state != yard.truth(bay)) ++wrong_first;
    }
  }
  const double bay_hours = hours * static_cast<double>(yard.bays().size());
  Outcome outcome;
  outcome.labels = {{"part", "people"}, {"seed", std::to_string(seed)}};
  outcome.numbers = {{"bay_hours", bay_hours},
                     {"in_view_hours", in_view_s / 3600.0},
                     {"flips", static_cast<double>(flips)},
                     {"wrong_first", static_cast<double>(wrong_first)},
                     {"scan_cpu_ms", 1e3 * cpu_s / (static_cast<double>(scans) / 50.0)}};
  return outcome;
}

std::vector<Run> bays_runs(const Options& options) {
  std::vector<Run> runs;
  const double minutes = options.minutes.value_or(options.quick ? 5.0 : kSeenMinutes);
  daemon::Settings settings;
  settings.localizer = options.localizer;
  settings.mapping = options.mapping;
  for (const std::uint64_t seed : options.seeds(10)) {
    runs.push_back({"seen-seed" + std::to_string(seed), [=] { return seen_outcome(settings, minutes, seed); }});
  }
  const double hours = options.quick ? 0.25 : kPeopleHours;
  for (const std::uint64_t seed : options.seeds(20)) {
    runs.push_back({"people-seed" + std::to_string(seed), [=] { return people_outcome(hours, seed); }});
  }
  return runs;
}

template <std::size_t kColumns>
TextTable table_of_part(const std::string& title, const std::vector<const Outcome*>& outcomes,
                        const std::array<const char*, kColumns>& columns) {
  TextTable table{title, {"seed"}, {}};
  table.columns.insert(table.columns.end(), columns.begin(), columns.end());
  for (const Outcome* outcome : outcomes) {
    std::vector<std::string> row{outcome->label("seed")};
    for (const char* column : columns) row.push_back(text_of(outcome->number(column)));
    table.rows.push_back(std::move(row));
  }
  return table;
}

void add_seen(Report& report, const std::vector<const Outcome*>& seen) {
  constexpr Ratio kSoon{"right_3s", "seen_3s"};
  constexpr Ratio kSurely{"right_10s", "seen_10s"};
  const std::vector<Figure> figures{
      sum_of_runs("loads that were in view for 3 s after they had changed", seen, "seen_3s"),
      ratio_of_runs("state right after 3 s of view", seen, kSoon, Target{.least = 0.97}),
      ratio_of_runs("precision after 10 s of view", seen, {"right_10s", "told_10s"}, Target{.least = 0.99}),
      ratio_of_runs("recall after 10 s of view", seen, kSurely, Target{.least = 0.99}),
      ratio_of_runs("states, each second of each bay, that were not so when they say they were seen", seen,
                    {"not_so_when_seen", "states"}, Target{.most = 0.0}),
      sum_of_runs("states of bays at which nobody has looked", seen, "never_looked", Target{.most = 0.0})};
  report.figures.insert(report.figures.end(), figures.begin(), figures.end());
  report.charts.push_back(
      ratios_in_order("states that are right, share", {{"after 3 s of view", kSoon}, {"after 10 s", kSurely}}, seen));
  report.tables.push_back(table_of_part(
      "Loads that come and go", seen,
      std::array{"seen_3s", "right_3s", "seen_10s", "told_10s", "right_10s", "states", "not_so_when_seen"}));
}

void add_people(Report& report, const std::vector<const Outcome*>& people) {
  constexpr Ratio kFlips{"flips", "bay_hours", 3000.0};
  const std::vector<Figure> figures{sum_of_runs("bay-hours among ten people", people, "bay_hours"),
                                    sum_of_runs("of those in view", people, "in_view_hours"),
                                    ratio_of_runs("false flips in 3000 bay-hours", people, kFlips, Target{.most = 3.0}),
                                    sum_of_runs("first states that were wrong", people, "wrong_first"),
                                    mean_of_runs("processor a scan, mean", people, "scan_cpu_ms", {}, "ms")};
  report.figures.insert(report.figures.end(), figures.begin(), figures.end());
  report.charts.push_back(ratios_in_order("false flips in 3000 bay-hours", {{"flips", kFlips}}, people));
  report.tables.push_back(
      table_of_part("Ten people", people, std::array{"bay_hours", "in_view_hours", "flips", "wrong_first"}));
}

Report bays_report(const std::vector<Outcome>& outcomes) {
  Report report;
  if (const auto seen = runs_with(outcomes, {{"part", "seen"}}); !seen.empty()) add_seen(report, seen);
  if (const auto people = runs_with(outcomes, {{"part", "people"}}); !people.empty()) add_people(report, people);
  return report;
}

}  // namespace

Experiment bays_experiment() {
  return {.name = "bays",
          .what = "Bays that fill and empty, and ten people: told rightly, and how soon?",
          .runs = bays_runs,
          .report = bays_report,
          .times = Experiment::Times::kThread};
}

}  // namespace deltamap::experiments
