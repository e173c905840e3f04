// SPDX-License-Identifier: Apache-2.0
#include "simulation/score/reference_score.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>

#include "core/statistics/summary.hpp"

namespace deltamap::simulation::score {
namespace {

constexpr double kMatchS = 0.05;  // between an estimate and its reference
constexpr double kLostM = 0.5;
// Of the time between two estimates: as far one of them speaks for a denser reference. More than half, for intervals
// differ; less than one, for where an estimate is missing its neighbours do not stand in.
constexpr double kReachOfInterval = 0.75;

std::vector<double> numbers_in(const std::string& line) {
  std::istringstream fields(line);
  std::vector<double> numbers;
  for (double number = 0.0; fields >> number;) numbers.push_back(number);
  return fields.eof() ? numbers : std::vector<double>{};
}

std::optional<StampedPose> pose_of(const std::vector<double>& n) {
  if (n.size() != 4 && n.size() != 8) return std::nullopt;
  if (!std::all_of(n.begin(), n.end(), [](double number) { return std::isfinite(number); })) return std::nullopt;
  const double theta = n.size() == 4 ? n[3] : 2.0 * std::atan2(n[6], n[7]);
  return StampedPose{Timestamp{duration_from_seconds(n[0])}, {n[1], n[2], wrapped_angle(theta)}};
}

bool is_earlier(const StampedPose& a, const StampedPose& b) { return a.time < b.time; }

/// Index of the nearest in time; nothing where none lies within the reach.
std::optional<std::size_t> match_of(const std::vector<StampedPose>& reference, Timestamp time, double reach_s) {
  const auto after = std::lower_bound(reference.begin(), reference.end(), StampedPose{time, {}}, is_earlier);
  std::optional<std::size_t> nearest;
  double least_s = reach_s;
  const auto look_at = [&](std::vector<StampedPose>::const_iterator one) {
    const double away_s = std::abs(seconds(one->time - time));
    if (away_s > least_s) return;
    least_s = away_s;
    nearest = static_cast<std::size_t>(one - reference.begin());
  };
  if (after != reference.begin()) look_at(after - 1);
  if (after != reference.end()) look_at(after);
  return nearest;
}

/// How far an estimate speaks for the reference around it.
double reach_of(const std::vector<StampedPose>& estimates) {
  std::vector<double> intervals_s;
  for (std::size_t i = 1; i < estimates.size(); ++i)
    intervals_s.push_back(seconds(estimates[i].time - estimates[i - 1].time));
  return intervals_s.empty() ? kMatchS : std::max(kMatchS, kReachOfInterval * deltamap::quantile(intervals_s, 0.5));
}

/// For each pose of the reference the error of the estimate that speaks for it. `errors_m`: of each estimate.
std::vector<std::optional<double>> errors_along(const std::vector<StampedPose>& reference,
                                                const std::vector<StampedPose>& estimates,
                                                const std::vector<std::optional<double>>& errors_m) {
  const double reach_s = reach_of(estimates);
  std::vector<std::optional<double>> along;
  for (const StampedPose& pose : reference) {
    const auto nearest = match_of(estimates, pose.time, reach_s);
    along.push_back(nearest ? errors_m[*nearest] : std::nullopt);
  }
  return along;
}

}  // namespace

std::vector<StampedPose> read_reference(const std::filesystem::path& file) {
  std::ifstream in(file);
  if (!in || std::filesystem::is_directory(file)) throw std::runtime_error(file.string() + ": cannot be read");
  std::vector<StampedPose> poses;
  int number = 0;
  for (std::string line; std::getline(in, line);) {
    ++number;
    if (line.empty() || line.front() == '#') continue;
    const auto pose = pose_of(numbers_in(line));
    if (!pose) {
      throw std::runtime_error(file.string() + ": line " + std::to_string(number) +
                               ": not a pose (t x y theta, or t x y z qx qy qz qw)");
    }
    poses.push_back(*pose);
  }
  if (poses.empty()) throw std::runtime_error(file.string() + ": line 1: holds no pose");
  std::stable_sort(poses.begin(), poses.end(), is_earlier);
  return poses;
}

std::vector<StampedPose> laser_poses(std::vector<StampedPose> of_robot, const Pose2& robot_from_laser) {
  for (StampedPose& pose : of_robot) pose.map_from_robot = pose.map_from_robot * robot_from_laser;
  return of_robot;
}

std::vector<StampedPose> reference_at(const std::vector<StampedPose>& trajectory, const Truth& truth) {
  std::vector<StampedPose> reference;
  for (const StampedPose& pose : trajectory) {
    if (truth.poses.empty() || pose.time < truth.poses.front().time || pose.time > truth.poses.back().time) continue;
    reference.push_back({pose.time, pose_at(truth, pose.time)});
  }
  std::stable_sort(reference.begin(), reference.end(), is_earlier);
  return reference;
}

std::vector<StampedPose> reference_within(const std::vector<StampedPose>& trajectory,
                                          const std::vector<StampedPose>& reference) {
  if (trajectory.empty()) return {};
  const auto [first, last] = std::minmax_element(trajectory.begin(), trajectory.end(), is_earlier);
  const auto reach = duration_from_seconds(kMatchS);
  const StampedPose begin{first->time - reach, {}};
  const StampedPose end{last->time + reach, {}};
  return {std::lower_bound(reference.begin(), reference.end(), begin, is_earlier),
          std::upper_bound(reference.begin(), reference.end(), end, is_earlier)};
}

ReferenceScore reference_score(std::vector<StampedPose> trajectory, const std::vector<StampedPose>& reference) {
  std::stable_sort(trajectory.begin(), trajectory.end(), is_earlier);
  std::vector<double> errors_m;
  std::vector<double> turns_rad;
  std::vector<std::optional<double>> of_each;
  for (const StampedPose& pose : trajectory) {
    const auto match = match_of(reference, pose.time, kMatchS);
    of_each.emplace_back();
    if (!match) continue;
    const Pose2& truth = reference[*match].map_from_robot;
    errors_m.push_back(deltamap::distance_between(pose.map_from_robot, truth));
    turns_rad.push_back(std::abs(turn_between(truth.theta, pose.map_from_robot.theta)));
    of_each.back() = errors_m.back();
  }
  ReferenceScore score{.matched = errors_m.size(), .of = reference.size()};
  if (errors_m.empty()) return score;
  score.rmse_m = root_mean_square(errors_m);
  score.median_m = deltamap::quantile(errors_m, 0.5);
  score.p95_m = deltamap::quantile(errors_m, 0.95);
  score.max_m = *std::max_element(errors_m.begin(), errors_m.end());
  score.median_heading_rad = deltamap::quantile(turns_rad, 0.5);
  score.p95_heading_rad = deltamap::quantile(turns_rad, 0.95);
  const auto at = errors_along(reference, trajectory, of_each);
  const auto count = static_cast<double>(reference.size());
  score.coverage = static_cast<double>(std::count_if(at.begin(), at.end(), [](const auto& e) { return !!e; })) / count;
  std::size_t lost_from = 0;
  std::size_t lost = 0;
  for (std::size_t i = 0; i < at.size(); ++i) {
    if (at[i] && *at[i] <= kLostM) {
      lost_from = i + 1;
      continue;
    }
    ++lost;
    score.longest_lost_s = std::max(score.longest_lost_s, seconds(reference[i].time - reference[lost_from].time));
  }
  score.lost_share = static_cast<double>(lost) / count;
  return score;
}

}  // namespace deltamap::simulation::score
