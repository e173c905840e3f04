// SPDX-License-Identifier: Apache-2.0
#include "localization/hypotheses/prior_search.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/scans/cast_ends.hpp"
#include "tests/support/worlds/drawn_flat.hpp"
#include "tests/support/worlds/symmetric_hall.hpp"

namespace deltamap::localization::hypotheses {
namespace {

constexpr double kCoarseM = 0.25;
constexpr int kHeadings = 96;

PoseCovariance spread_of(double position_m, double heading_rad) {
  return Eigen::Vector3d{position_m * position_m, position_m * position_m, heading_rad * heading_rad}.asDiagonal();
}

/// A map, and the poses within a prior at which a scan from the truth fits.
struct PosesFound {
  PosesFound(const OccupancyGrid& map, const Pose2& truth, const sensor::RefinedPose& prior) {
    const sensor::LikelihoodField field{map, {}};
    const sensor::CoarseField coarse{map, field, kCoarseM};
    Random random{3};
    const motion::BeamEnds ends = test::cast_ends(map, truth, {}, random, 60);
    poses = poses_within(prior, coarse, field, {ends, ends}, kHeadings);
  }
  std::vector<sensor::ProposedPose> poses;
};

bool is_at(const sensor::ProposedPose& found, const Pose2& pose) {
  return distance_between(found.map_from_robot, pose) < 0.05 &&
         std::abs(turn_between(found.map_from_robot.theta, pose.theta)) < radians(1.0);
}

TEST(PriorSearch, FindsThePoseMetresFromWhereItWasExpected) {
  const Pose2 truth{4.5, 2.0, 1.1};
  const PosesFound found{test::drawn_flat(), truth, {{3.3, 2.6, 0.8}, spread_of(1.0, 0.3)}};
  ASSERT_FALSE(found.poses.empty());
  EXPECT_TRUE(is_at(found.poses.front(), truth)) << found.poses.front().map_from_robot.x;
  EXPECT_NEAR(found.poses.front().log_prior, -0.5 * (1.2 * 1.2 + 0.6 * 0.6 + 1.0), 0.3);
}

TEST(PriorSearch, FindsNothingOfWhatThePriorExcludes) {
  const Pose2 truth{4.5, 2.0, 1.1};
  const PosesFound found{test::drawn_flat(), truth, {{2.0, 2.6, 0.8}, spread_of(0.2, 0.1)}};
  for (const sensor::ProposedPose& pose : found.poses) EXPECT_FALSE(is_at(pose, truth));
}

TEST(PriorSearch, LetsThePriorChooseBetweenTwoPosesThatFitAlike) {
  const OccupancyGrid hall = test::symmetric_hall();
  const Pose2 truth{5.0, 4.5, 0.4};
  const Pose2 alias = test::turned_about_the_middle(truth, 1);
  const sensor::RefinedPose nearer_to_truth{{truth.x + 0.3, truth.y, truth.theta}, spread_of(1.5, 1.0)};
  const PosesFound found{hall, truth, nearer_to_truth};
  ASSERT_GT(found.poses.size(), 1u);
  EXPECT_TRUE(is_at(found.poses.front(), truth));
  bool knows_alias = false;
  for (const sensor::ProposedPose& pose : found.poses) knows_alias = knows_alias || is_at(pose, alias);
  EXPECT_TRUE(knows_alias) << "later scans may speak for it";
}

TEST(PriorSearch, ProposesNothingWithoutEnds) {
  const OccupancyGrid map = test::drawn_flat();
  const sensor::LikelihoodField field{map, {}};
  const sensor::CoarseField coarse{map, field, kCoarseM};
  EXPECT_TRUE(poses_within({{4.5, 2.0, 1.1}, spread_of(1.0, 0.3)}, coarse, field, {{}, {}}, kHeadings).empty());
}

}  // namespace
}  // namespace deltamap::localization::hypotheses
