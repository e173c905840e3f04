// SPDX-License-Identifier: Apache-2.0
#include "experiments/verdict/verdict_run.hpp"

#include <cmath>
#include "experiments/drive/view_difference.hpp"

namespace deltamap::experiments {
namespace {

constexpr double kDriving_m_per_s = 0.05;
constexpr double kTurning_rad_per_s = radians(3.0);
constexpr double kMostWaiting = 2.0;  // times the driving that is wanted: then the run ends all the same

constexpr double kOracle_s = 30.0;  // of driving: the path that the oracle sees
constexpr double kViewEvery_s = 2.5;

constexpr double kOtherEndShare = 0.05;  // of the beams end elsewhere: the map is wrong here

/// Whether the robot moved or turned between two scans.
bool has_driven(const Pose2& before, const Pose2& now, double dt_s) {
  return distance_between(before, now) > kDriving_m_per_s * dt_s ||
         std::abs(turn_between(before.theta, now.theta)) > kTurning_rad_per_s * dt_s;
}

/// Where this run's robot begins: on the free floor of the place as M_0 shows it.
Pose2 beginning_of(const VerdictPlace& place, const VerdictRun& run) {
  const simulation::VirtualDrive drive{place.scenario, {.seed = run.seed, .people = place.people}};
  Random random{run.seed + 7919};
  return drive.place_anywhere(random);
}

MappingDrive drive_of(const VerdictPlace& place, const localization::belief::StabilityRecord& lived_in,
                      const VerdictRun& run) {
  simulation::VirtualDriveParams drive{
      .seed = run.seed, .map_from_start = beginning_of(place, run), .max_range_m = run.max_range_m};
  drive.people = place.people;
  daemon::StartMap start{.map = place.map};
  start.stability = lived_in;
  return {place.scenario, drive, localizer_alone(place.localizer), start};
}

void happen(const VerdictRun& run, simulation::VirtualDrive& drive, Random& random) {
  if (run.changed_share > 0.0) (void)drive.change_many(run.changed_share, busy_forklift(1.0));
  befall(drive, run.event, random);
}

/// The way since the event, and what the laser looked at on it.
class WaySinceEvent {
 public:
  void observe(const Mapped& scan, const Pose2& map_from_laser) {
    if (last_ && has_driven(last_->map_from_robot, scan.map_from_robot, scan.passed_s - last_->passed_s)) {
      driven_s_ += scan.passed_s - last_->passed_s;
    }
    last_ = Passed{scan.map_from_robot, scan.passed_s};
    if (driven_s_ <= kOracle_s && driven_s_ >= kViewEvery_s * static_cast<double>(views_.size())) {
      views_.push_back(map_from_laser);
    }
  }
  [[nodiscard]] double driven_s() const { return driven_s_; }
  [[nodiscard]] const std::vector<Pose2>& views() const { return views_; }

 private:
  struct Passed {
    Pose2 map_from_robot;
    double passed_s = 0.0;
  };
  std::optional<Passed> last_;
  std::vector<Pose2> views_;  // map_from_laser, one now and then while driving
  double driven_s_ = 0.0;
};

ScanTable no_scans() {
  return ScanTable{{"since_event_s", "driven_s", "x_m", "y_m", "theta_rad", "error_m", "heading_error_rad", "state",
                    "pose_right", "map_wrong", "verdict", "map_is_wrong", "stable_expected", "stable_fit",
                    "rival_share"}};
}

void add_scan(ScanTable& scans, const Mapped& scan, double since_event_s, double driven_s, bool map_is_wrong) {
  const PoseError error = error_of(scan);
  const Belief& belief = scan.estimate.belief;
  scans.add({since_event_s, driven_s, scan.map_from_robot.x, scan.map_from_robot.y, scan.map_from_robot.theta,
             error.position.norm(), error.heading_rad, static_cast<double>(scan.estimate.state), belief.pose_right,
             belief.map_wrong, static_cast<double>(belief.verdict), map_is_wrong ? 1.0 : 0.0,
             static_cast<double>(belief.stable.expected), static_cast<double>(belief.stable.fit), belief.other_share});
}

/// With what the oracle says of the way.
VerdictScans judged(ScanTable scans, const AmbiguityOracle& oracle, const std::vector<Pose2>& views,
                    const simulation::RayCaster& surfaces, double max_range_m) {
  VerdictScans answer{std::move(scans), oracle.ambiguity(views, surfaces, max_range_m)};
  const std::size_t needed = oracle.views_needed(views, surfaces, max_range_m, answer.path);
  answer.unique_after_s = needed > 0 ? kViewEvery_s * static_cast<double>(needed - 1) : std::nan("");
  return answer;
}

}  // namespace

VerdictScans verdict_scans(const VerdictPlace& place, const localization::belief::StabilityRecord& lived_in,
                           const VerdictRun& run) {
  MappingDrive pair = drive_of(place, lived_in, run);
  const simulation::RayCaster as_mapped{place.scenario.world};
  Random random{run.seed + 104729};
  ScanTable scans = no_scans();
  std::optional<double> event_s;
  WaySinceEvent way;
  const double end_s = run.before_s + kMostWaiting * run.after_driving_s;
  for (double passed_s = 0.0; passed_s < end_s && way.driven_s() < run.after_driving_s;) {
    if (!event_s && passed_s >= run.before_s) {
      event_s = passed_s;
      happen(run, pair.drive(), random);
    }
    const Mapped scan = pair.next();
    passed_s = scan.passed_s;
    const Pose2 map_from_laser = scan.map_from_robot * place.scenario.laser.optics.robot_from_laser;
    if (event_s) way.observe(scan, map_from_laser);
    const bool differs =
        event_s && run.changed_share > 0.0 &&
        differing_share(pair.drive().surfaces(), as_mapped, map_from_laser, run.max_range_m) > kOtherEndShare;
    add_scan(scans, scan, passed_s - event_s.value_or(run.before_s), way.driven_s(), differs);
  }
  return judged(std::move(scans), *place.oracle, way.views(), pair.drive().surfaces(), run.max_range_m);
}

}  // namespace deltamap::experiments
