// SPDX-License-Identifier: Apache-2.0
#include "mapping/alignment/pose_network.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>

#include "core/random.hpp"

namespace deltamap::mapping::alignment {
namespace {

Pose2 moved(const Pose2& pose, int axis, double step) {
  Pose2 result = pose;
  (axis == 0 ? result.x : axis == 1 ? result.y : result.theta) += step;
  return result;
}

TEST(LinkError, HasTheDerivativesThatDifferencesShow) {
  constexpr double kStep = 1e-6;
  constexpr double kTolerance = 1e-7;
  Random random{1};
  for (int trial = 0; trial < 20; ++trial) {
    const Pose2 from{random.normal(3.0), random.normal(3.0), random.uniform(-3.0, 3.0)};
    const Pose2 to{random.normal(3.0), random.normal(3.0), random.uniform(-3.0, 3.0)};
    const Pose2 measured = motion_between(from, to);
    const LinkError at = link_error(from, to, measured);
    EXPECT_LT(at.error.norm(), 1e-12);
    for (int axis = 0; axis < 3; ++axis) {
      const Eigen::Vector3d by_from = (link_error(moved(from, axis, kStep), to, measured).error -
                                       link_error(moved(from, axis, -kStep), to, measured).error) /
                                      (2.0 * kStep);
      const Eigen::Vector3d by_to = (link_error(from, moved(to, axis, kStep), measured).error -
                                     link_error(from, moved(to, axis, -kStep), measured).error) /
                                    (2.0 * kStep);
      EXPECT_LT((at.by_from.col(axis) - by_from).norm(), kTolerance);
      EXPECT_LT((at.by_to.col(axis) - by_to).norm(), kTolerance);
    }
  }
}

struct Loop {
  std::vector<Pose2> truth;
  std::vector<Pose2> initial;
  std::vector<PoseLink> links;
  PoseAnchor anchor;
};

PoseCovariance link_covariance() {
  PoseCovariance covariance = Eigen::Vector3d{0.01 * 0.01, 0.02 * 0.02, 0.005 * 0.005}.asDiagonal();
  covariance(0, 1) = covariance(1, 0) = 0.5 * 0.01 * 0.02;
  return covariance;
}

/// Poses around a square, each linked to the next and the last to the first, measured with noise.
Loop loop_of(std::uint32_t count, Random& random) {
  Loop loop;
  for (std::uint32_t i = 0; i < count; ++i) {
    const double along = 2.0 * std::numbers::pi * i / count;
    loop.truth.push_back({5.0 * std::cos(along), 5.0 * std::sin(along), wrapped_angle(along + 1.5)});
  }
  loop.anchor = {0, loop.truth[0], 1e-6 * PoseCovariance::Identity()};
  loop.initial.push_back(loop.truth[0]);
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::uint32_t next = (i + 1) % count;
    const Pose2 exact = motion_between(loop.truth[i], loop.truth[next]);
    const Pose2 measured{exact.x + random.normal(0.01), exact.y + random.normal(0.02),
                         exact.theta + random.normal(0.005)};
    loop.links.push_back({i, next, measured, link_covariance(), next == 0});
    if (next != 0) loop.initial.push_back(loop.initial.back() * measured);
  }
  return loop;
}

/// The same problem by dense normal equations, iterated.
std::vector<Pose2> dense_solution(const Loop& loop, Eigen::MatrixXd* covariance) {
  std::vector<Pose2> poses = loop.initial;
  const auto size = static_cast<Eigen::Index>(3 * poses.size());
  for (int iteration = 0; iteration < 20; ++iteration) {
    Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(size, size);
    Eigen::VectorXd right_side = Eigen::VectorXd::Zero(size);
    matrix.topLeftCorner<3, 3>() += loop.anchor.covariance.inverse();
    const Pose2& a = loop.anchor.frame_from_pose;
    right_side.head<3>() -= loop.anchor.covariance.inverse() *
                            Eigen::Vector3d{poses[0].x - a.x, poses[0].y - a.y, turn_between(a.theta, poses[0].theta)};
    for (const PoseLink& link : loop.links) {
      const LinkError at = link_error(poses[link.from], poses[link.to], link.from_from_to);
      Eigen::MatrixXd jacobian = Eigen::MatrixXd::Zero(3, size);
      jacobian.block<3, 3>(0, 3 * static_cast<Eigen::Index>(link.from)) = at.by_from;
      jacobian.block<3, 3>(0, 3 * static_cast<Eigen::Index>(link.to)) = at.by_to;
      matrix += jacobian.transpose() * link.covariance.inverse() * jacobian;
      right_side -= jacobian.transpose() * link.covariance.inverse() * at.error;
    }
    const Eigen::VectorXd step = matrix.lu().solve(right_side);
    for (std::size_t i = 0; i < poses.size(); ++i) {
      const auto at = 3 * static_cast<Eigen::Index>(i);
      poses[i] = {poses[i].x + step[at], poses[i].y + step[at + 1], wrapped_angle(poses[i].theta + step[at + 2])};
    }
    *covariance = matrix.inverse();
  }
  return poses;
}

TEST(PoseNetwork, EqualsTheDenseSolutionOnLoops) {
  Random random{2};
  for (const std::uint32_t count : {3U, 8U, 40U}) {
    const Loop loop = loop_of(count, random);
    const PoseNetwork network = solved_network(loop.initial, loop.links, {&loop.anchor, 1}, {});
    ASSERT_TRUE(network.solved);
    EXPECT_TRUE(network.dropped.empty());
    Eigen::MatrixXd covariance;
    const std::vector<Pose2> dense = dense_solution(loop, &covariance);
    for (std::size_t i = 0; i < count; ++i) {
      EXPECT_LT(distance_between(network.poses[i], dense[i]), 1e-6);
      EXPECT_LT(std::abs(turn_between(network.poses[i].theta, dense[i].theta)), 1e-6);
      const auto at = 3 * static_cast<Eigen::Index>(i);
      EXPECT_LT((network.covariances[i] - covariance.block<3, 3>(at, at)).norm(), 1e-6);
    }
  }
}

TEST(PoseNetwork, ClosesALoopBetterThanOdometryAlone) {
  Random random{3};
  double odometry_error = 0.0;
  double network_error = 0.0;
  for (int trial = 0; trial < 20; ++trial) {
    const Loop loop = loop_of(40, random);
    const PoseNetwork network = solved_network(loop.initial, loop.links, {&loop.anchor, 1}, {});
    ASSERT_TRUE(network.solved);
    odometry_error += distance_between(loop.initial.back(), loop.truth.back());
    network_error += distance_between(network.poses.back(), loop.truth.back());
  }
  EXPECT_LT(network_error, 0.4 * odometry_error);
}

TEST(PoseNetwork, DropsALinkThatContradictsTheOthers) {
  Random random{4};
  Loop loop = loop_of(20, random);
  PoseLink wrong{3, 12, motion_between(loop.truth[3], loop.truth[12]) * Pose2{1.0, 0.5, 0.2}, link_covariance(), true};
  PoseLink right{4, 14, motion_between(loop.truth[4], loop.truth[14]), link_covariance(), true};
  loop.links.push_back(wrong);
  loop.links.push_back(right);
  const PoseNetwork network = solved_network(loop.initial, loop.links, {&loop.anchor, 1}, {});
  ASSERT_TRUE(network.solved);
  EXPECT_EQ(network.dropped, std::vector<std::uint32_t>{20U});
  EXPECT_LT(distance_between(network.poses[12], loop.truth[12]), 0.15);
}

TEST(PoseNetwork, IsNotSolvedWhereNothingHoldsAPose) {
  const std::vector<Pose2> poses(3);
  const PoseLink link{0, 1, {1.0, 0.0, 0.0}, link_covariance(), true};
  const PoseAnchor anchor{0, {}, PoseCovariance::Identity()};
  EXPECT_FALSE(solved_network(poses, {&link, 1}, {&anchor, 1}, {}).solved);
  EXPECT_FALSE(solved_network({}, {}, {}, {}).solved);
}

}  // namespace
}  // namespace deltamap::mapping::alignment
