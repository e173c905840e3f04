// SPDX-License-Identifier: Apache-2.0
#include "localization/sensor/pose_refinement.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/scans/cast_ends.hpp"
#include "tests/support/worlds/pillar_room.hpp"

namespace deltamap::localization::sensor {
namespace {

motion::BeamEnds ends_from(const OccupancyGrid& map, const Pose2& map_from_robot) {
  return test::cast_ends(map, map_from_robot, {.noise_m = 0.005});
}

TEST(Refinement, MovesAPoseToWhereTheScanFits) {
  const OccupancyGrid map = test::pillar_room();
  const LikelihoodField field{map, {}};
  const PoseCovariance loose = Eigen::Vector3d{0.04, 0.04, 0.01}.asDiagonal();
  for (const Pose2& truth : {Pose2{1.5, 1.2, 0.4}, Pose2{3.0, 3.1, -1.9}, Pose2{5.2, 1.0, 2.7}}) {
    const motion::BeamEnds ends = ends_from(map, truth);
    const Pose2 off{truth.x + 0.06, truth.y - 0.05, truth.theta + 0.03};
    const RefinedPose found = refined(field, ends, {off, loose}, 0.1, {.steps = 10});
    EXPECT_LT(distance_between(found.map_from_robot, truth),
              0.04);  // ranges end at a cell's face, contours at its middle
    EXPECT_LT(std::abs(turn_between(found.map_from_robot.theta, truth.theta)), 0.005);
    EXPECT_LT(found.covariance.trace(), loose.trace());
  }
}

TEST(Refinement, DoesNotMoveAlongACorridorThatShowsNoEnd) {
  OccupancyGrid corridor{{800, 60, 0.05, {-20.0, -1.5}}, CellState::kOccupied};
  test::fill_box(corridor, {-20.0, -1.0}, {20.0, 1.0}, CellState::kFree);
  const motion::BeamEnds ends = test::cast_ends(corridor, {0.0, 0.0, 0.0}, {.max_range_m = 8.0});
  const PoseCovariance spread = Eigen::Vector3d{0.04, 0.01, 0.001}.asDiagonal();
  const RefinedPose found =
      refined(LikelihoodField{corridor, {}}, ends, {{0.1, 0.05, 0.02}, spread}, 0.1, {.steps = 10, .prior_share = 1.0});
  EXPECT_NEAR(found.map_from_robot.x, 0.1, 0.03);
  EXPECT_NEAR(found.map_from_robot.y, 0.0, 0.03);
  EXPECT_GT(found.covariance(0, 0), 0.5 * spread(0, 0));
  EXPECT_LT(found.covariance(1, 1), 0.1 * spread(1, 1));
}

TEST(Refinement, RefusesToGoFarFromWhatTheParticlesSay) {
  const OccupancyGrid map = test::pillar_room();
  const RefinedPose prior{{1.65, 1.2, 0.4}, Eigen::Vector3d{0.1, 0.1, 0.1}.asDiagonal()};
  const RefinedPose found = refined(LikelihoodField{map, {}}, ends_from(map, {1.5, 1.2, 0.4}), prior, 1.0,
                                    {.steps = 20, .longest_shift_m = 0.05});
  EXPECT_EQ(found.map_from_robot, prior.map_from_robot);
}

TEST(Refinement, LeavesThePoseWithoutEndsOrSteps) {
  const OccupancyGrid map = test::pillar_room();
  const LikelihoodField field{map, {}};
  const RefinedPose prior{{1.55, 1.2, 0.4}, PoseCovariance::Zero()};
  EXPECT_EQ(refined(field, {}, prior, 1.0, {}).map_from_robot, prior.map_from_robot);
  EXPECT_EQ(refined(field, ends_from(map, {1.5, 1.2, 0.4}), prior, 1.0, {.steps = 0}).map_from_robot,
            prior.map_from_robot);
}

}  // namespace
}  // namespace deltamap::localization::sensor
