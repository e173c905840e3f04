// SPDX-License-Identifier: Apache-2.0
#include "localization/belief/beam_check.hpp"

#include <gtest/gtest.h>

#include "localization/motion/deskew.hpp"
#include "localization/sensor/straight_walk.hpp"
#include "tests/support/worlds/drawn_flat.hpp"
#include "tests/support/worlds/drawn_grid.hpp"

namespace deltamap::localization::belief {
namespace {

const Pose2 kTruth{4.0, 1.6, 0.1};
const PoseCovariance kSure = Eigen::Vector3d{1e-4, 1e-4, 1e-5}.asDiagonal();

struct Counted {
  int fit = 0, short_of = 0, beyond = 0, silent = 0;
};

/// What a scan of `world` from kTruth says on the map of the flat, with the robot believed at `believed`.
Counted checked(const OccupancyGrid& world, const Pose2& believed, const PoseCovariance& covariance = kSure) {
  Random random{3};
  const Scan scan = test::cast_scan(world, kTruth, timestamp_from_ns(1), {}, random);
  const std::vector<RayInRobot> rays = motion::deskewed(scan, {});
  BeamCheck check;
  Counted counted;
  for (const CheckedBeam& beam : check.check(test::drawn_flat(), scan, rays, {believed, covariance})) {
    counted.fit += beam.what == BeamFit::kFit ? 1 : 0;
    counted.short_of += beam.what == BeamFit::kShort ? 1 : 0;
    counted.beyond += beam.what == BeamFit::kBeyond ? 1 : 0;
    counted.silent += beam.what == BeamFit::kSilent ? 1 : 0;
  }
  return counted;
}

TEST(BeamCheck, FindsEveryBeamFittingWhereTheMapAndThePoseAreRight) {
  const Counted counted = checked(test::drawn_flat(), kTruth);
  EXPECT_EQ(counted.fit, 72);
  EXPECT_EQ(counted.short_of + counted.beyond, 0);
}

TEST(BeamCheck, CallsBeamsShortThatEndAtSomethingNew) {
  OccupancyGrid world = test::drawn_flat();
  test::fill_box(world, {5.0, 1.4}, {5.4, 2.2}, CellState::kOccupied);
  const Counted counted = checked(world, kTruth);
  EXPECT_GT(counted.short_of, 12);
  EXPECT_EQ(counted.beyond, 0);
}

TEST(BeamCheck, CallsBeamsBeyondThatGoThroughWhatIsGone) {
  OccupancyGrid world = test::drawn_flat();
  test::fill_box(world, {8.0, 1.0}, {8.9, 1.6}, CellState::kFree);
  const Counted counted = checked(world, kTruth);
  EXPECT_GE(counted.beyond, 2);
  EXPECT_EQ(counted.short_of, 0);
}

TEST(BeamCheck, FindsMuchAmissAtAWrongPose) {
  const Counted counted = checked(test::drawn_flat(), {4.6, 1.2, 0.1});
  EXPECT_GT(counted.short_of + counted.beyond, 40);
}

TEST(BeamCheck, ForgivesWhatThePosesUncertaintyExplains) {
  const Pose2 near{4.08, 1.55, 0.11};
  const PoseCovariance unsure = Eigen::Vector3d{6e-3, 6e-3, 4e-4}.asDiagonal();
  EXPECT_EQ(checked(test::drawn_flat(), near, unsure).beyond, 0);
  EXPECT_EQ(checked(test::drawn_flat(), near, unsure).short_of, 0);
}

TEST(BeamCheck, SaysNothingWithAPoseThatIsUnknown) {
  const PoseCovariance unknown = Eigen::Vector3d{1.0, 1.0, 0.1}.asDiagonal();
  EXPECT_EQ(checked(test::drawn_flat(), kTruth, unknown).silent, 72);
}

TEST(BeamCheck, SaysNothingFromInsideAnObstacleOrOutsideTheMap) {
  EXPECT_EQ(checked(test::drawn_flat(), {8.5, 1.3, 0.0}).silent, 72);
  EXPECT_EQ(checked(test::drawn_flat(), {80.0, 1.3, 0.0}).silent, 72);
}

TEST(StraightWalk, MeetsTheFirstCellThatIsNotFreeAndNothingBeyondTheEnd) {
  const OccupancyGrid map = test::drawn_grid({"......#.", "....... "});
  EXPECT_EQ(sensor::first_met(map, {0.5, 1.5}, {1.0, 0.0}, 0.0, 7.0).what, CellState::kOccupied);
  EXPECT_EQ(sensor::first_met(map, {0.5, 1.5}, {1.0, 0.0}, 0.0, 7.0).cell, (Cell{6, 1}));
  EXPECT_EQ(sensor::first_met(map, {0.5, 1.5}, {1.0, 0.0}, 0.0, 5.4).what, CellState::kFree);
  EXPECT_EQ(sensor::first_met(map, {0.5, 0.5}, {1.0, 0.0}, 0.0, 7.0).what, CellState::kUnknown);
  EXPECT_EQ(sensor::first_met(map, {0.5, 0.5}, {-1.0, 0.0}, 0.0, 7.0).what, CellState::kUnknown) << "left the map";
  EXPECT_EQ(sensor::first_met(map, {0.5, 0.5}, {-1.0, 0.0}, 3.0, 7.0).what, CellState::kUnknown) << "begins outside";
}

}  // namespace
}  // namespace deltamap::localization::belief
