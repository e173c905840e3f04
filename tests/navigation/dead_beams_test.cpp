// SPDX-License-Identifier: Apache-2.0
#include "navigation/dead_beams.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "core/geometry/angle.hpp"

namespace deltamap::navigation {
namespace {

constexpr std::size_t kCoveredFrom = 120;  // of 181 beams: a third, to the left
constexpr double kPlacesApartM = 0.11;     // farther than two places are apart

/// A robot in a room of 24 m by 6 m that its map has, with a laser a part of whose window may be covered.
class Look {
 public:
  Look() {
    OccupancyGrid map{{240, 60, 0.1, {0.0, 0.0}}, CellState::kFree};
    for (int x = 0; x < 240; ++x) map.set(Cell{x, 0}, CellState::kOccupied), map.set({x, 59}, CellState::kOccupied);
    for (int y = 0; y < 60; ++y) map.set({0, y}, CellState::kOccupied), map.set({239, y}, CellState::kOccupied);
    tracked.estimate.map = std::make_shared<const OccupancyGrid>(std::move(map));
    tracked.estimate.map_from_robot = {2.0, 3.0, 0.0};
    tracked.estimate.state = LocalizerState::kTracking;
    tracked.scan.first_bearing_rad = radians(-90.0);
    tracked.scan.bearing_step_rad = radians(1.0);
    tracked.scan.max_range_m = 32.0;
    cover(false);
  }
  void cover(bool is_covered) {
    tracked.scan.beams.clear();
    for (int i = 0; i < 181; ++i) tracked.scan.beams.push_back({i % 2 == 0 ? 3.0F : 3.02F, 0.0F, BeamKind::kRange});
    for (std::size_t i = kCoveredFrom; is_covered && i < 181; ++i)
      tracked.scan.beams[i].kind = BeamKind::kBeyondMaximum;
  }
  void drive(double way_m) {
    for (double gone_m = 0.0; gone_m < way_m; gone_m += kPlacesApartM) {
      tracked.estimate.map_from_robot.x += kPlacesApartM;
      look();
    }
  }
  void look() {
    beams.observe(tracked.scan);
    if (is_pose_trusted) beams.hold_against_map(tracked);
  }

  DeadBeams beams;
  TrackedScan tracked;
  bool is_pose_trusted = true;
};

TEST(DeadBeams, HideASectorOnceTheyHaveMissedWallsFromManyPlaces) {
  Look look;
  look.cover(true);
  look.drive(5.0);
  EXPECT_FALSE(look.beams.hide_a_sector()) << "what has gone from the map may be as wide";
  look.drive(3.0);
  EXPECT_TRUE(look.beams.hide_a_sector());
}

TEST(DeadBeams, SeeAgainWhereTheRobotStandsOnceTheWindowIsClean) {
  for (const bool is_pose_trusted : {true, false}) {
    Look look;
    look.cover(true);
    look.drive(8.0);
    ASSERT_TRUE(look.beams.hide_a_sector());
    look.is_pose_trusted = is_pose_trusted;
    for (int i = 0; i < 100; ++i) look.look();
    EXPECT_TRUE(look.beams.hide_a_sector()) << "still covered";
    look.cover(false);
    look.look();
    EXPECT_FALSE(look.beams.hide_a_sector());
    look.look();
    EXPECT_FALSE(look.beams.hide_a_sector());
  }
}

TEST(DeadBeams, AreCountedAnewOnceAPersonHasSaidDrive) {
  Look look;
  look.cover(true);
  look.drive(8.0);
  ASSERT_TRUE(look.beams.hide_a_sector());
  look.beams.begin_anew();
  EXPECT_FALSE(look.beams.hide_a_sector());
  look.drive(5.0);
  EXPECT_FALSE(look.beams.hide_a_sector());
  look.drive(3.0);
  EXPECT_TRUE(look.beams.hide_a_sector());
}

TEST(DeadBeams, DoNotSeeByImplausibleRanges) {
  Look look;
  look.cover(true);
  look.drive(8.0);
  look.cover(false);
  look.tracked.scan.implausible = true;
  look.look();
  EXPECT_TRUE(look.beams.hide_a_sector());
}

TEST(DeadBeams, AreNotCountedTwiceFromOnePlaceNorWithoutAPose) {
  Look stands;
  stands.cover(true);
  for (int i = 0; i < 1000; ++i) stands.look();
  EXPECT_FALSE(stands.beams.hide_a_sector());
  Look lost;
  lost.cover(true);
  lost.tracked.estimate.state = LocalizerState::kLost;
  lost.drive(15.0);
  EXPECT_FALSE(lost.beams.hide_a_sector());
}

TEST(DeadBeams, AreNoneWhereTheMapHasNothingInTheirWay) {
  Look look;
  look.tracked.estimate.map =
      std::make_shared<const OccupancyGrid>(GridGeometry{240, 60, 0.1, {0.0, 0.0}}, CellState::kFree);
  look.cover(true);
  look.drive(15.0);
  EXPECT_FALSE(look.beams.hide_a_sector());
}

}  // namespace
}  // namespace deltamap::navigation
