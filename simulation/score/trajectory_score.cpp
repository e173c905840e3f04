// SPDX-License-Identifier: Apache-2.0
#include "simulation/score/trajectory_score.hpp"

#include <algorithm>
#include <cmath>

#include "simulation/score/number_lines.hpp"

namespace deltamap::simulation::score {
namespace {

constexpr double kFarOff_m = 0.5;

/// The value below which a share of the sorted values lies.
double quantile(const std::vector<double>& sorted, double share) {
  if (sorted.empty()) return 0.0;
  const auto index = static_cast<std::size_t>(std::lround(share * static_cast<double>(sorted.size() - 1)));
  return sorted[index];
}

}  // namespace

std::vector<StampedPose> read_trajectory(const std::filesystem::path& tum_file) {
  std::vector<StampedPose> trajectory;
  for (const auto& [t, x, y, z, qx, qy, qz, qw] : number_lines(tum_file, "pose", "t x y z qx qy qz qw")) {
    trajectory.push_back({Timestamp{duration_from_seconds(t)}, {x, y, wrapped_angle(2.0 * std::atan2(qz, qw))}});
  }
  return trajectory;
}

TrajectoryScore trajectory_score(const std::vector<StampedPose>& trajectory, const Truth& truth) {
  std::vector<double> errors_m;
  std::vector<double> turns_rad;
  for (const StampedPose& pose : trajectory) {
    if (pose.time < truth.poses.front().time || pose.time > truth.poses.back().time) continue;
    const Pose2 true_pose = pose_at(truth, pose.time);
    errors_m.push_back(deltamap::distance_between(pose.map_from_robot, true_pose));
    turns_rad.push_back(std::abs(turn_between(pose.map_from_robot.theta, true_pose.theta)));
  }
  std::sort(errors_m.begin(), errors_m.end());
  std::sort(turns_rad.begin(), turns_rad.end());
  TrajectoryScore score;
  score.poses = errors_m.size();
  if (errors_m.empty()) return score;
  const auto far = errors_m.end() - std::upper_bound(errors_m.begin(), errors_m.end(), kFarOff_m);
  score.median_m = quantile(errors_m, 0.5);
  score.p95_m = quantile(errors_m, 0.95);
  score.max_m = errors_m.back();
  score.share_beyond_half_metre = static_cast<double>(far) / static_cast<double>(errors_m.size());
  score.median_heading_rad = quantile(turns_rad, 0.5);
  return score;
}

}  // namespace deltamap::simulation::score
