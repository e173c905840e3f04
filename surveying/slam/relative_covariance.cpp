// SPDX-License-Identifier: Apache-2.0
#include "surveying/slam/relative_covariance.hpp"

#include <cmath>
#include <functional>
#include <limits>
#include <queue>
#include <utility>

#include "core/geometry/points_in_map.hpp"

namespace deltamap::surveying::slam {
namespace {

constexpr double kArmM = 10.0;  // what a heading that is off by a radian counts, m

double cost_of(const PoseCovariance& covariance) {
  return covariance(0, 0) + covariance(1, 1) + kArmM * kArmM * covariance(2, 2);
}

/// Of what lies `arm` on from there, were the step known exactly.
double least_cost(const PoseCovariance& known, const Point2& arm) {
  return known(0, 0) + known(1, 1) + 2.0 * (arm.x() * known(1, 2) - arm.y() * known(0, 2)) +
         (arm.squaredNorm() + kArmM * kArmM) * known(2, 2);
}

Eigen::Matrix3d turned_by(double theta) {
  const double c = std::cos(theta);
  const double s = std::sin(theta);
  Eigen::Matrix3d turn;
  turn << c, -s, 0.0, s, c, 0.0, 0.0, 0.0, 1.0;
  return turn;
}

}  // namespace

PoseCovariance composed_covariance(const Pose2& a_from_b, const PoseCovariance& of_a_from_b, const Pose2& b_from_c,
                                   const PoseCovariance& of_b_from_c) {
  const Eigen::Matrix3d turn = turned_by(a_from_b.theta);
  const Point2 arm = turn.topLeftCorner<2, 2>() * b_from_c.position();
  Eigen::Matrix3d by_first = Eigen::Matrix3d::Identity();
  by_first(0, 2) = -arm.y();
  by_first(1, 2) = arm.x();
  return by_first * of_a_from_b * by_first.transpose() + turned_covariance(of_b_from_c, a_from_b.theta);
}

PoseCovariance turned_covariance(const PoseCovariance& covariance, double turn_rad) {
  const Eigen::Matrix3d turn = turned_by(turn_rad);
  return turn * covariance * turn.transpose();
}

PoseCovariance inverted_covariance(const Pose2& a_from_b, const PoseCovariance& of_a_from_b) {
  const Pose2 b_from_a = inverse(a_from_b);
  Eigen::Matrix3d by = -turned_by(b_from_a.theta);
  by(0, 2) = b_from_a.y;
  by(1, 2) = -b_from_a.x;
  return by * of_a_from_b * by.transpose();
}

std::vector<std::optional<PoseCovariance>> relative_covariances(const Survey& survey, std::uint32_t seen_from,
                                                                std::span<const std::uint32_t> wanted) {
  std::vector<char> is_wanted(survey.keyframes.size(), 0);
  for (const std::uint32_t node : wanted) is_wanted[node] = 1;
  std::size_t left = wanted.size();
  std::vector<char> is_settled(survey.keyframes.size(), 0);
  std::vector<double> least(survey.keyframes.size(), std::numeric_limits<double>::infinity());
  std::vector<PoseCovariance> best(survey.keyframes.size());
  using Waiting = std::pair<double, std::uint32_t>;
  std::priority_queue<Waiting, std::vector<Waiting>, std::greater<>> waiting;
  best[seen_from] = PoseCovariance::Zero();
  least[seen_from] = 0.0;
  waiting.emplace(0.0, seen_from);
  while (!waiting.empty() && left > 0) {
    const std::uint32_t node = waiting.top().second;
    waiting.pop();
    if (is_settled[node] != 0) continue;
    is_settled[node] = 1;
    left -= is_wanted[node] != 0 ? 1 : 0;
    const Pose2 here = motion_between(survey.poses[seen_from], survey.poses[node]);
    const Pose2 node_from_survey = inverse(survey.poses[node]);
    const PointsInMap turned{{0.0, 0.0, here.theta}};
    for (const std::uint32_t place : survey.links_of[node]) {
      const mapping::alignment::PoseLink& link = survey.links[place];
      const bool onward = link.from == node;
      const std::uint32_t next = onward ? link.to : link.from;
      if (is_settled[next] != 0) continue;
      const Pose2 step = node_from_survey * survey.poses[next];
      if (least_cost(best[node], turned(step.position())) >= least[next]) continue;
      const PoseCovariance of_step = onward ? link.covariance : inverted_covariance(link.from_from_to, link.covariance);
      const PoseCovariance covariance = composed_covariance(here, best[node], step, of_step);
      if (cost_of(covariance) >= least[next]) continue;
      best[next] = covariance;
      least[next] = cost_of(covariance);
      waiting.emplace(least[next], next);
    }
  }
  std::vector<std::optional<PoseCovariance>> found;
  found.reserve(wanted.size());
  for (const std::uint32_t node : wanted) {
    found.push_back(is_settled[node] != 0 ? std::optional{best[node]} : std::nullopt);
  }
  return found;
}

}  // namespace deltamap::surveying::slam
