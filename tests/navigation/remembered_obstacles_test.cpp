// SPDX-License-Identifier: Apache-2.0
#include "navigation/remembered_obstacles.hpp"

#include <gtest/gtest.h>

#include "core/geometry/angle.hpp"
#include "navigation/wander.hpp"

namespace deltamap::navigation {
namespace {

const Pose2 kPose{3.0, 2.0, radians(90.0)};

TransientObstacles thing_at(const Point2& place) {
  TransientObstacles transients;
  transients.blocks = {100, 100, 0.1, {0.0, 0.0}};
  transients.standing = {static_cast<std::uint32_t>(transients.blocks.index_of(transients.blocks.cell_at(place)))};
  return transients;
}

/// A scan in the middle of nothing: every beam ends at 6 m, unless the kind says otherwise.
TrackedScan open_view(BeamKind ahead = BeamKind::kRange) {
  TrackedScan tracked;
  tracked.scan.time = timestamp_from_ns(1'000'000'000);
  tracked.scan.first_bearing_rad = radians(-90.0);
  tracked.scan.bearing_step_rad = radians(1.0);
  tracked.scan.max_range_m = 8.0;
  tracked.scan.beams.assign(181, Beam{6.0F, 0.0F, BeamKind::kRange});
  for (std::size_t i = 89; i <= 91; ++i) tracked.scan.beams[i] = {0.0F, 0.0F, ahead};
  if (ahead == BeamKind::kRange) {
    for (std::size_t i = 89; i <= 91; ++i) tracked.scan.beams[i].range_m = 6.0F;
  }
  tracked.estimate.state = LocalizerState::kTracking;
  tracked.estimate.map_from_robot = kPose;
  return tracked;
}

TEST(RememberedObstacles, LieInTheRobotsFrame) {
  const auto obstacles = remembered_obstacles(thing_at({3.02, 1.01}), open_view(), {});  // behind, where nobody looks
  ASSERT_EQ(obstacles.size(), 1u);
  EXPECT_NEAR(obstacles[0].x(), -0.95, 0.06);
  EXPECT_NEAR(obstacles[0].y(), 0.0, 0.06);
}

TEST(RememberedObstacles, HaveLeftWhereEveryBeamGoesThrough) {
  EXPECT_TRUE(remembered_obstacles(thing_at({3.0, 4.0}), open_view(), {}).empty());
}

TEST(RememberedObstacles, HaveLeftOrStayByWhereTheLaserIsMounted) {
  TrackedScan tracked = open_view();
  tracked.estimate.map_from_robot = {5.0, 5.0, 0.0};
  tracked.scan.robot_from_laser = {0.2, 0.1, radians(90.0)};  // from 0° ahead over the left to 180° behind
  EXPECT_TRUE(remembered_obstacles(thing_at({3.75, 5.75}), tracked, {}).empty()) << "behind on the left: seen through";
  EXPECT_EQ(remembered_obstacles(thing_at({5.75, 3.75}), tracked, {}).size(), 1u)
      << "ahead on the right: not looked at";
  tracked.scan.robot_from_laser = {-1.0, 0.0, 0.0};
  for (Beam& beam : tracked.scan.beams) beam.range_m = 2.6F;
  EXPECT_EQ(remembered_obstacles(thing_at({6.85, 5.05}), tracked, {}).size(), 1u)
      << "1.9 m ahead of the robot, 2.9 m of a laser at its stern: no beam reaches it";
}

TEST(RememberedObstacles, StayWhereABeamBringsNothingBack) {
  EXPECT_EQ(remembered_obstacles(thing_at({3.0, 4.0}), open_view(BeamKind::kNotValid), {}).size(), 1u);
}

TEST(RememberedObstacles, AreNoneFarAwayUnderTheHullOrWithoutAPose) {
  EXPECT_TRUE(remembered_obstacles(thing_at({9.0, 0.5}), open_view(), {}).empty());
  EXPECT_TRUE(remembered_obstacles(thing_at({3.05, 1.95}), open_view(), {}).empty());
  EXPECT_EQ(remembered_obstacles(thing_at({3.0, 1.6}), open_view(), {}).size(), 1u);
  EXPECT_TRUE(remembered_obstacles(thing_at({3.0, 1.6}), open_view(), {.hull_m = 0.5}).empty()) << "a wider robot";
  TrackedScan lost = open_view();
  lost.estimate.state = LocalizerState::kLost;
  EXPECT_TRUE(remembered_obstacles(thing_at({3.02, 1.01}), lost, {}).empty());
}

TEST(Wander, StopsBeforeAThingThatIsKnownToStandThereAlthoughTheScanDoesNotShowIt) {
  TrackedScan tracked = open_view(BeamKind::kNotValid);
  const auto obstacles = remembered_obstacles(thing_at({3.0, 2.6}), tracked, {});
  ASSERT_FALSE(obstacles.empty());
  Wander blind{{}, 1};
  EXPECT_GT(blind.step(tracked).speed_m_per_s, 0.2) << "three lost beams alone hide nothing so near";
  Wander knowing{{}, 1};
  EXPECT_EQ(knowing.step(tracked, obstacles).speed_m_per_s, 0.0);
}

}  // namespace
}  // namespace deltamap::navigation
