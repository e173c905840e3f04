// SPDX-License-Identifier: Apache-2.0
#include "simulation/score/relation_score.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "simulation/score/number_lines.hpp"

namespace deltamap::simulation::score {
namespace {

constexpr double kLongestGapS = 5.0;  // between two scans: of what the robot did in a longer one nothing is told

/// Nothing outside of the trajectory, nor in a gap of it.
std::optional<Pose2> pose_at(const std::vector<StampedPose>& trajectory, Timestamp time) {
  const auto after = std::lower_bound(trajectory.begin(), trajectory.end(), time,
                                      [](const StampedPose& pose, Timestamp t) { return pose.time < t; });
  if (after == trajectory.end()) return std::nullopt;
  if (after->time == time) return after->map_from_robot;
  if (after == trajectory.begin()) return std::nullopt;
  const StampedPose& before = *(after - 1);
  if (seconds(after->time - before.time) > kLongestGapS) return std::nullopt;
  const double share = seconds(time - before.time) / seconds(after->time - before.time);
  return interpolated(before.map_from_robot, after->map_from_robot, share);
}

MeanAndDeviation mean_and_deviation(const std::vector<double>& values) {
  MeanAndDeviation of;
  if (values.empty()) return of;
  const auto count = static_cast<double>(values.size());
  for (const double value : values) of.mean += value / count;
  double squares = 0.0;
  for (const double value : values) squares += (value - of.mean) * (value - of.mean) / count;
  of.deviation = std::sqrt(squares);
  return of;
}

std::vector<double> squared(std::vector<double> values) {
  for (double& value : values) value *= value;
  return values;
}

}  // namespace

std::vector<Relation> read_relations(const std::filesystem::path& file) {
  std::vector<Relation> relations;
  for (const auto& [t1, t2, x, y, z, roll, pitch, yaw] : number_lines(file, "relation", "t1 t2 x y z roll pitch yaw")) {
    relations.push_back(
        {Timestamp{duration_from_seconds(t1)}, Timestamp{duration_from_seconds(t2)}, {x, y, wrapped_angle(yaw)}});
  }
  return relations;
}

RelationScore relation_score(std::vector<StampedPose> trajectory, const std::vector<Relation>& relations) {
  std::stable_sort(trajectory.begin(), trajectory.end(),
                   [](const StampedPose& a, const StampedPose& b) { return a.time < b.time; });
  RelationScore score;
  std::vector<double> off_m;
  std::vector<double> off_rad;
  for (const Relation& relation : relations) {
    const auto first = pose_at(trajectory, relation.first);
    const auto second = pose_at(trajectory, relation.second);
    if (!first || !second) {
      ++score.outside;
      continue;
    }
    const Pose2 error = motion_between(relation.first_from_second, motion_between(*first, *second));
    off_m.push_back(error.position().norm());
    off_rad.push_back(std::abs(error.theta));
  }
  score.relations = off_m.size();
  score.translation_m = mean_and_deviation(off_m);
  score.translation2_m2 = mean_and_deviation(squared(off_m));
  score.rotation_rad = mean_and_deviation(off_rad);
  score.rotation2_rad2 = mean_and_deviation(squared(off_rad));
  return score;
}

}  // namespace deltamap::simulation::score
