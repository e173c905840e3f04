// SPDX-License-Identifier: Apache-2.0
#include "localization/sensor/normal_equations.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "core/random.hpp"
#include "tests/support/scans/cast_scan.hpp"
#include "tests/support/worlds/pillar_room.hpp"

namespace deltamap::localization::sensor {
namespace {

motion::BeamEnds end_at(double x_m, double y_m) { return {{static_cast<float>(x_m)}, {static_cast<float>(y_m)}}; }

/// What the sums over a single end tell of it: its distance from the contour and how that changes with the pose.
struct OneEnd {
  double distance_m = 0.0;
  Eigen::Vector3d slope;
};
OneEnd one_end(const LikelihoodField& field, const motion::BeamEnds& ends, const Pose2& pose) {
  const NormalEquations of = normal_equations(field, ends, pose);
  const double distance_m = std::sqrt(of.squares_m2 / of.explained);
  const double variance_m2 = field.hit_deviation_m() * field.hit_deviation_m();
  return {distance_m, of.pull * variance_m2 / (of.explained * distance_m)};
}

TEST(NormalEquations, KnowHowADistanceChangesWithThePose) {
  const LikelihoodField field{test::pillar_room(), {}};
  Random random{8};
  constexpr double kStep = 1e-3;
  int looked_at = 0;
  for (int i = 0; i < 4000; ++i) {
    const Point2 end{random.uniform(0.1, 2.0), random.uniform(-0.5, 0.5)};
    const motion::BeamEnds ends = end_at(end.x(), end.y());
    const Pose2 pose{random.uniform(0.3, 4.0), random.uniform(0.6, 3.4), random.uniform(-0.5, 0.5)};
    const OneEnd at = one_end(field, ends, pose);
    const std::array<Pose2, 3> ahead{Pose2{pose.x + kStep, pose.y, pose.theta},
                                     Pose2{pose.x, pose.y + kStep, pose.theta},
                                     Pose2{pose.x, pose.y, pose.theta + kStep}};
    for (std::size_t axis = 0; axis < ahead.size(); ++axis) {
      const OneEnd then = one_end(field, ends, ahead[axis]);
      const double slope_between =
          0.5 * (at.slope[static_cast<Eigen::Index>(axis)] + then.slope[static_cast<Eigen::Index>(axis)]);
      const bool same_cell = (at.slope - then.slope).norm() < 0.02;  // slopes jump where a cell ends
      if (!std::isfinite(slope_between) || !same_cell) continue;
      ++looked_at;
      EXPECT_NEAR((then.distance_m - at.distance_m) / kStep, slope_between, 2e-3);
    }
  }
  EXPECT_GT(looked_at, 1000);
}

TEST(NormalEquations, FindNoDistanceOnAContourAndTheRightOneBesideIt) {
  const LikelihoodField field{test::pillar_room(), {}};
  EXPECT_NEAR(normal_equations(field, end_at(0.0, 0.0), {-0.025, 1.975, 0.0}).squares_m2, 0.0, 1e-9);
  EXPECT_NEAR(one_end(field, end_at(0.0, 0.0), {0.025, 1.975, 0.0}).distance_m, 0.05, 1e-5);
  EXPECT_NEAR(one_end(field, end_at(0.0, 0.0), {0.050, 1.975, 0.0}).distance_m, 0.075, 1e-5);
}

TEST(NormalEquations, AreTheSumOverTheEndsHoweverManyThereAre) {
  const LikelihoodField field{test::pillar_room(), {}};
  const Pose2 pose{1.5, 1.2, 0.4};
  Random random{3};
  motion::BeamEnds all;
  NormalEquations sum{Eigen::Matrix3d::Zero(), Eigen::Vector3d::Zero()};
  for (int count = 1; count <= 11; ++count) {
    const Point2 end{random.uniform(-1.7, 4.0), random.uniform(-1.4, 2.8)};
    const motion::BeamEnds one = end_at(end.x(), end.y());
    all.x_m.push_back(one.x_m.front());
    all.y_m.push_back(one.y_m.front());
    const NormalEquations of_one = normal_equations(field, one, pose);
    sum.information += of_one.information;
    sum.pull += of_one.pull;
    sum.explained += of_one.explained;
    sum.squares_m2 += of_one.squares_m2;
    const NormalEquations of_all = normal_equations(field, all, pose);
    EXPECT_TRUE(of_all.information.isApprox(sum.information, 1e-5));
    EXPECT_TRUE(of_all.pull.isApprox(sum.pull, 1e-5));
    EXPECT_NEAR(of_all.explained, sum.explained, 1e-5);
    EXPECT_NEAR(of_all.squares_m2, sum.squares_m2, 1e-6);
  }
  EXPECT_GT(sum.explained, 0.5);
}

TEST(NormalEquations, WeighAnEndByHowProbablyTheMapExplainsIt) {
  const LikelihoodField field{test::pillar_room(), {}};
  const double random_share = field.params().random_share;
  for (const double away_m : {0.01, 0.04, 0.09, 0.13}) {
    const Pose2 pose{away_m - 0.025, 1.975, 0.0};
    const NormalEquations of = normal_equations(field, end_at(0.0, 0.0), pose);
    const double distance_m = std::sqrt(of.squares_m2 / of.explained);
    const double hit = (1.0 - random_share) * std::exp(-0.5 * std::pow(distance_m / field.hit_deviation_m(), 2));
    EXPECT_NEAR(distance_m, away_m, 1e-4);
    EXPECT_NEAR(of.explained, hit / (hit + random_share), 1e-4);
  }
}

TEST(NormalEquations, SayNothingFarOutsideTheMapAndWithoutEnds) {
  const LikelihoodField field{test::pillar_room(), {}};
  for (const motion::BeamEnds& ends : {motion::BeamEnds{}, end_at(1e9, -1e9), end_at(-3.0, 0.0)}) {
    const NormalEquations of = normal_equations(field, ends, {});
    EXPECT_TRUE(of.information.isZero(0.0));
    EXPECT_TRUE(of.pull.isZero(0.0));
    EXPECT_EQ(of.explained, 0.0);
  }
}

}  // namespace
}  // namespace deltamap::localization::sensor
