// SPDX-License-Identifier: Apache-2.0
#include "localization/sensor/mapped_beams.hpp"

#include <gtest/gtest.h>

#include "tests/support/worlds/drawn_grid.hpp"

namespace deltamap::localization::sensor {
namespace {

class MappedBeamsTest : public testing::Test {
 protected:
  /// With the laser at (1.5, 1.5), looking along x.
  [[nodiscard]] bool tells(const Point2& end_in_map) const { return from(end_in_map, {1.5, 1.5}); }
  [[nodiscard]] bool from(const Point2& end_in_map, const Point2& laser) const {
    const MappedBeams mapped{map_, field_, {{laser.x() - 0.25, laser.y(), 0.0}, {}}, {0.25, 0.0}};
    return mapped.tells(end_in_map - laser + Point2{0.25, 0.0});
  }

  OccupancyGrid map_ =
      test::drawn_grid({"########    ", "#......#    ", "#......     ", "#......#    ", "########    "});
  LikelihoodField field_{map_, {.hit_deviation_m = 0.1}};
};

TEST_F(MappedBeamsTest, TellWhereTheyEndAtAnObstacleOrInFreeSpace) {
  EXPECT_TRUE(tells({7.4, 1.5}));
  EXPECT_TRUE(tells({4.5, 2.5}));
}

TEST_F(MappedBeamsTest, TellWhereTheyGoThroughAnObstacleIntoWhatTheMapDoesNotKnow) { EXPECT_TRUE(tells({10.5, 1.5})); }

TEST_F(MappedBeamsTest, TellNothingWhereTheyLeaveTheKnownMap) {
  EXPECT_FALSE(from({10.5, 2.5}, {1.5, 2.5})) << "through the door";
  EXPECT_FALSE(from({20.5, 2.5}, {1.5, 2.5})) << "beyond the map";
}

TEST_F(MappedBeamsTest, TellOnlyOfObstaclesWhereTheRobotHasLeftTheKnownMap) {
  EXPECT_FALSE(from({11.5, 2.5}, {9.5, 2.5}));
  EXPECT_TRUE(from({7.6, 1.5}, {9.5, 1.5}));
}

/// Ends in free space, 0.3 and 0.6 m before what the map does not know.
TEST(MappedBeams, TellEverywhereOnlyWhereEveryPoseWithinTheDoubtIsTold) {
  const OccupancyGrid map = test::drawn_grid(
      {"########    ", "#......     ", "#......     ", "#......     ", "#......     ", "#......     ", "########    "});
  const LikelihoodField field{map, {.hit_deviation_m = 0.1}};
  PoseCovariance doubtful = PoseCovariance::Zero();
  doubtful(0, 0) = doubtful(1, 1) = 0.04;
  const Pose2 robot{1.5, 3.5, 0.0};
  const MappedBeams sure{map, field, {robot, PoseCovariance::Zero()}, {0.0, 0.0}};
  const MappedBeams unsure{map, field, {robot, doubtful}, {0.0, 0.0}};
  const MappedBeams lost{map, field, {robot, 100.0 * doubtful}, {0.0, 0.0}};
  const Point2 near{5.2, 0.0};  // at x = 6.7 of 7 m that are known
  const Point2 before{4.9, 0.0};
  EXPECT_TRUE(sure.tells_everywhere(near));
  EXPECT_TRUE(unsure.tells(near));
  EXPECT_FALSE(unsure.tells_everywhere(near));
  EXPECT_TRUE(unsure.tells_everywhere(before));
  EXPECT_TRUE(lost.tells_everywhere(before)) << "half a metre at most";
}

}  // namespace
}  // namespace deltamap::localization::sensor
