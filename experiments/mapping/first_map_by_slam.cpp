// SPDX-License-Identifier: Apache-2.0
// `first-map`: a robot is driven through a building that nobody has a map of, twice, from two places, and SLAM makes
// the first map. Buildings, lasers, wheels and people are those of `unseen`; nothing in the building is moved
// meanwhile.
#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>
#include <string>

#include "daemon/steps/survey_step.hpp"
#include "daemon/telemetry/cpu_timer.hpp"
#include "experiments/mapping/calm_drives.hpp"
#include "experiments/mapping/unseen_drive.hpp"
#include "experiments/registry.hpp"
#include "experiments/seed_summary.hpp"
#include "mapping/registration/contour_score.hpp"
#include "simulation/drawn/unseen_world.hpp"
#include "surveying/slam/drawn_map.hpp"

namespace deltamap::experiments {
namespace {

using surveying::slam::Survey;

constexpr int kSeeds = 40;
constexpr int kQuickSeeds = 3;
constexpr double kMinutes = 16.0;  // both drives together
constexpr double kQuickMinutes = 4.0;
constexpr double kResolutionM = 0.05;
constexpr double kWrongLoopM = 0.5;  // off the truth
constexpr double kWrongLoopRad = radians(10.0);

/// The rigid motion that brings the ones onto the others with the least squares of distances.
Pose2 best_motion(const std::vector<Pose2>& from, const std::vector<Pose2>& to) {
  const auto count = static_cast<double>(from.size());
  Point2 middle_from{0.0, 0.0};
  Point2 middle_to{0.0, 0.0};
  for (const Pose2& pose : from) middle_from += pose.position() / count;
  for (const Pose2& pose : to) middle_to += pose.position() / count;
  double along = 0.0;
  double across = 0.0;
  for (std::size_t i = 0; i < from.size(); ++i) {
    const Point2 a = from[i].position() - middle_from;
    const Point2 b = to[i].position() - middle_to;
    along += a.dot(b);
    across += a.x() * b.y() - a.y() * b.x();
  }
  Pose2 motion{0.0, 0.0, std::atan2(across, along)};
  const Point2 shift = middle_to - motion * middle_from;
  motion.x = shift.x();
  motion.y = shift.y();
  return motion;
}

struct Surveyed {
  daemon::SurveyStep step;
  std::vector<Pose2> truth{};  ///< of each keyframe
  double cpu_s = 0.0;
};

void survey_world(std::uint64_t seed, double minutes, Surveyed& surveyed) {
  std::map<Timestamp, Pose2> true_poses;
  surveyed.step.begin_drive();
  drive_calmly(seed, minutes,
               {.step =
                    [&](simulation::DriveStep&& now) {
                      const daemon::CpuTimer timer{surveyed.cpu_s};
                      for (const Odometry& odometry : now.odometry) surveyed.step.observe(odometry);
                      true_poses.emplace(now.scan.time, now.map_from_robot);
                      surveyed.step.observe(std::move(now.scan));
                    },
                .begin_second = [&](simulation::DriveStep&&) { surveyed.step.begin_drive(); }});
  const daemon::CpuTimer timer{surveyed.cpu_s};
  if (!surveyed.step.finish()) throw std::runtime_error("first-map: the pose graph of a seed does not settle");
  for (const surveying::slam::Keyframe& keyframe : surveyed.step.slam().survey().keyframes) {
    surveyed.truth.push_back(true_poses.at(keyframe.scan.time()));
  }
}

/// Loops, and those of them that the truth contradicts.
std::pair<int, int> loops_of(const Survey& survey, const std::vector<Pose2>& truth) {
  int all = 0;
  int wrong = 0;
  for (const auto& link : survey.links) {
    if (!link.may_drop) continue;
    const Pose2 off = motion_between(motion_between(truth[link.from], truth[link.to]), link.from_from_to);
    ++all;
    wrong += off.position().norm() > kWrongLoopM || std::abs(off.theta) > kWrongLoopRad ? 1 : 0;
  }
  return {all, wrong};
}

/// Contour F1 against what the same scans draw at the true poses.
double contour_f1(const Survey& survey, std::vector<Pose2> truth, const Pose2& truth_from_survey) {
  Survey as_it_was = survey;
  for (std::size_t i = 0; i < truth.size(); ++i) as_it_was.poses[i] = inverse(truth_from_survey) * truth[i];
  const Pose2 to_axes{0.0, 0.0, surveying::slam::turn_to_axes(survey)};
  return mapping::registration::contour_score(surveying::slam::drawn_map(as_it_was, to_axes, kResolutionM),
                                              surveying::slam::drawn_map(survey, to_axes, kResolutionM))
      .f1();
}

/// Of the keyframes, as the best rigid motion onto the truth leaves them.
struct KeyframeErrors {
  double rms_m = 0.0;
  double most_m = 0.0;
  double heading_rms_rad = 0.0;
};

KeyframeErrors errors_of(const std::vector<Pose2>& estimated, const std::vector<Pose2>& truth,
                         const Pose2& truth_from_survey) {
  double squares = 0.0;
  double turn_squares = 0.0;
  double most_m = 0.0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const Eigen::Vector3d off = difference(truth[i], truth_from_survey * estimated[i]);
    squares += off.head<2>().squaredNorm();
    turn_squares += off.z() * off.z();
    most_m = std::max(most_m, off.head<2>().norm());
  }
  const auto count = static_cast<double>(truth.size());
  return {std::sqrt(squares / count), most_m, std::sqrt(turn_squares / count)};
}

/// Of a survey whose drives are done.
Outcome outcome_of(std::uint64_t seed, const Surveyed& surveyed) {
  const Survey& survey = surveyed.step.slam().survey();
  const auto keyframes = static_cast<double>(survey.keyframes.size());
  std::vector<Pose2> estimated;
  std::vector<Pose2> truth;
  for (const std::uint32_t node : survey.joined_nodes()) {
    estimated.push_back(survey.poses[node]);
    truth.push_back(surveyed.truth[node]);
  }
  const Pose2 truth_from_survey = best_motion(estimated, truth);
  const KeyframeErrors errors = errors_of(estimated, truth, truth_from_survey);
  const auto [loops, wrong_loops] = loops_of(survey, surveyed.truth);
  const auto kind = simulation::drawn::unseen_kind(seed);
  Outcome outcome;
  outcome.labels = {{"seed", std::to_string(seed)},
                    {"layout", std::string{name_of(kind.layout)}},
                    {"laser", drivers::lms200::name_of(kind.fan) + " " + text_of(kind.range_m) + "m"}};
  outcome.numbers = {{"error_rms_m", errors.rms_m},
                     {"error_most_m", errors.most_m},
                     {"heading_rms_deg", degrees(errors.heading_rms_rad)},
                     {"contour_f1", contour_f1(survey, surveyed.truth, truth_from_survey)},
                     {"joined", estimated.size() == survey.keyframes.size() ? 1.0 : 0.0},
                     {"keyframes", keyframes},
                     {"matched_share", static_cast<double>(surveyed.step.slam().matched()) / keyframes},
                     {"loops", static_cast<double>(loops)},
                     {"wrong_loops_share", loops == 0 ? 0.0 : static_cast<double>(wrong_loops) / loops},
                     {"slam_cpu_ms", 1e3 * surveyed.cpu_s},
                     {"speed_m_per_s", kind.speed_m_per_s},
                     {"people", kind.people.all}};
  return outcome;
}

Outcome survey_run(std::uint64_t seed, double minutes, const Options& options) {
  daemon::Settings settings;
  settings.localizer = options.localizer;
  Surveyed surveyed{daemon::SurveyStep{settings}};
  survey_world(seed, minutes, surveyed);
  return outcome_of(seed, surveyed);
}

std::vector<Run> runs_of(const Options& options) {
  return unseen_runs(options, {kSeeds, kQuickSeeds, kMinutes, kQuickMinutes},
                     [options](std::uint64_t seed, double minutes) { return survey_run(seed, minutes, options); });
}

Report report_of(const std::vector<Outcome>& outcomes) {
  Report report;
  report.figures = {count_of_seeds("seeds whose second drive was joined to the first", outcomes,
                                   [](const Outcome& o) { return o.number("joined") > 0.0; }),
                    count_of_seeds("seeds off by more than 1 m anywhere", outcomes,
                                   [](const Outcome& o) { return o.number("error_most_m") > 1.0; })};
  for (Figure& figure : spread_figures({{"error_rms_m", "m"},
                                        {"error_most_m", "m"},
                                        {"heading_rms_deg", "°"},
                                        {"contour_f1", "", Better::kMore},
                                        {"matched_share", "", Better::kMore},
                                        {"wrong_loops_share"},
                                        {"slam_cpu_ms", "ms"}},
                                       outcomes)) {
    report.figures.push_back(std::move(figure));
  }
  report.charts.push_back(chart_in_order("RMSE of the keyframes, m", "error_rms_m", outcomes));
  report.charts.push_back(chart_in_order("contour F1", "contour_f1", outcomes));
  return report;
}

}  // namespace

Experiment first_map_experiment() {
  return {.name = "first-map",
          .what = "The first map by SLAM: two drives through a building of `unseen` in which nothing is moved",
          .runs = runs_of,
          .report = report_of,
          .times = Experiment::Times::kThread};
}

}  // namespace deltamap::experiments
