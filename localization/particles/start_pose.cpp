// SPDX-License-Identifier: Apache-2.0
#include "localization/particles/start_pose.hpp"

#include <cmath>
#include <numbers>
#include <optional>
#include <stdexcept>

namespace deltamap::localization::particles {
namespace {

constexpr double kReach_m = 1.0;  // a pose that is farther from free space is no slip of the hand

std::optional<Point2> nearest_free(const OccupancyGrid& map, const Point2& from) {
  const int reach = static_cast<int>(kReach_m / map.resolution_m());
  const Cell middle = map.geometry().cell_at(from);
  std::optional<Point2> nearest;
  double least_m = kReach_m;
  for (int row = middle.row - reach; row <= middle.row + reach; ++row) {
    for (int column = middle.column - reach; column <= middle.column + reach; ++column) {
      if (map.at({column, row}) != CellState::kFree) continue;
      const Point2 centre = map.geometry().centre_of({column, row});
      const double away_m = (centre - from).norm();
      if (away_m > least_m) continue;
      least_m = away_m;
      nearest = centre;
    }
  }
  return nearest;
}

}  // namespace

Start usable_start(const OccupancyGrid& map, const InitialPose& given) {
  const Pose2& pose = given.map_from_robot;
  if (!std::isfinite(pose.x) || !std::isfinite(pose.y) || !std::isfinite(pose.theta)) {
    return {StartKind::kAnywhere, given};
  }
  if (std::hypot(pose.x - map.geometry().origin.x(), pose.y - map.geometry().origin.y()) > 1e6) {
    return {StartKind::kAnywhere, given};  // whole numbers of cells end somewhere
  }
  const std::optional<Point2> free = nearest_free(map, pose.position());
  if (!free) return {StartKind::kAnywhere, given};
  if (map.at(map.geometry().cell_at(pose.position())) != CellState::kOccupied) {
    return {given.remembered ? StartKind::kCheck : StartKind::kBelieve, given};
  }
  Start moved{StartKind::kCheck, given};
  moved.pose.position_deviation_m = std::hypot(given.position_deviation_m, (*free - pose.position()).norm());
  moved.pose.map_from_robot = {free->x(), free->y(), pose.theta};
  return moved;
}

ParticleCluster anywhere_in(const OccupancyGrid& map) {
  const CellBox known = known_box(map);
  const Point2 half = 0.5 * map.resolution_m() * Point2{known.width(), known.height()};
  const Point2 middle = map.geometry().origin + map.resolution_m() * Point2{known.first.column, known.first.row} + half;
  const double turn = std::numbers::pi;
  return {{middle.x(), middle.y(), 0.0},
          Eigen::Vector3d{half.x() * half.x() / 3.0, half.y() * half.y() / 3.0, turn * turn / 3.0}.asDiagonal(),
          0.0};
}

std::shared_ptr<const OccupancyGrid> with_free_space(std::shared_ptr<const OccupancyGrid> map) {
  if (!map || count_of(*map, CellState::kFree) == 0) throw std::runtime_error("the map has no free cell to be in");
  return map;
}

PoseCheck::Answer PoseCheck::observe(double fit, double enough) {
  if (scans_left_ == kScans) sum_ = 0.0;
  sum_ += fit;
  if (--scans_left_ > 0) return Answer::kNotYet;
  return sum_ >= enough * kScans ? Answer::kFits : Answer::kDoesNotFit;
}

}  // namespace deltamap::localization::particles
