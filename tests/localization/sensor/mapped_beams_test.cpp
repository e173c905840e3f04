// SPDX-License-Identifier: Apache-2.0
#include "localization/sensor/mapped_beams.hpp"

#include <gtest/gtest.h>

#include "tests/support/drawn_grid.hpp"

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

}  // namespace
}  // namespace deltamap::localization::sensor
