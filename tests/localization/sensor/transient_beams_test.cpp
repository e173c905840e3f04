// SPDX-License-Identifier: Apache-2.0
// What stands about for now: beams that end there are left out, and nothing is localized on it.
#include "localization/sensor/transient_beams.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <numbers>

#include "core/grid/near_occupied.hpp"
#include "localization/localizer.hpp"
#include "localization/localizer_params.hpp"
#include "tests/support/worlds/drawn_flat.hpp"

namespace deltamap::localization::sensor {
namespace {

const Pose2 kTruth{5.4, 1.6, std::numbers::pi};

/// Everything of `world` that the map does not have, as the transient layer would know it.
std::shared_ptr<const TransientObstacles> transients_of(const OccupancyGrid& world, const OccupancyGrid& map) {
  TransientObstacles transients;
  transients.blocks = {map.width() / 2, map.height() / 2, 2.0 * map.resolution_m(), map.geometry().origin};
  for (std::uint32_t i = 0; i < transients.blocks.cell_count(); ++i) {
    const Cell block = transients.blocks.cell_of(i);
    bool stands = false;
    for (int cell = 0; cell < 4; ++cell) {
      const Cell at{2 * block.column + cell % 2, 2 * block.row + cell / 2};
      stands = stands || (has_occupied_within(world, at, 1) && !has_occupied_within(map, at, 2));
    }
    if (stands) transients.standing.push_back(i);
  }
  return std::make_shared<const TransientObstacles>(std::move(transients));
}

/// The flat with goods left beside a wall: near enough to pull at the pose.
OccupancyGrid crowded() {
  OccupancyGrid world = test::drawn_flat();
  test::fill_box(world, {3.2, 0.6}, {3.5, 3.2}, CellState::kOccupied);
  return world;
}

struct Errors {
  double mean_m = 0.0;
  double trust = 0.0;
  std::size_t untracked = 0;
};

/// A robot that drives to and fro before a wall; after some time somebody leaves the goods there. The particles lead:
/// it is they that goods pull.
Errors driven(LocalizerParams params, bool is_told) {
  params.follow_surfaces = false;
  const OccupancyGrid map = test::drawn_flat();
  OccupancyGrid world = map;
  Pose2 truth = kTruth;
  Localizer localizer{params, std::make_shared<const OccupancyGrid>(map), particles::InitialPose{truth}, 1};
  Random random{7};
  Timestamp time = timestamp_from_ns(1'000'000'000'000);
  Pose2 odom;
  Errors errors;
  constexpr int kScans = 150;
  for (int i = -40; i < kScans; ++i) {
    if (i == 0) world = crowded();
    if (i == 0 && is_told) localizer.apply(transients_of(world, map));
    const Pose2 motion{(i + 40) / 10 % 2 == 0 ? 0.05 : -0.05, 0.0, 0.0};
    truth = truth * motion;
    odom = odom * Pose2{motion.x * 1.02, 0.0, 0.002};
    time += duration_from_seconds(0.2);
    localizer.observe(Odometry{.time = time, .odom_from_robot = odom});
    const TrackedScan tracked = localizer.observe(test::cast_scan(world, truth, time, {}, random));
    if (i < 0) continue;
    errors.mean_m += distance_between(tracked.estimate.map_from_robot, truth) / kScans;
    errors.trust += tracked.estimate.belief.pose_right / kScans;
    errors.untracked += tracked.estimate.state == LocalizerState::kTracking ? 0 : 1;
  }
  return errors;
}

TEST(TransientBeams, LeaveOutTheEndsAtThingsAndNoOthers) {
  TransientObstacles transients;
  transients.blocks = {20, 20, 0.1, {0.0, 0.0}};
  transients.standing = {static_cast<std::uint32_t>(transients.blocks.index_of({5, 5}))};
  const motion::BeamEnds ends{{0.05F, 0.25F, 3.0F}, {0.05F, 0.05F, 0.0F}};
  const motion::BeamEnds left = lasting_ends(ends, transients, {0.5, 0.5, 0.0}, {});
  EXPECT_EQ(left.x_m, (std::vector<float>{0.25F, 3.0F}));
  EXPECT_EQ(left.y_m, (std::vector<float>{0.05F, 0.0F}));
}

TEST(TransientBeams, ALocalizerThatIsToldOfACrowdIsNoWorseThanOneThatIsNot) {
  const Errors told = driven({}, true);
  const Errors untold = driven({}, false);
  EXPECT_LE(told.mean_m, untold.mean_m + 0.002);
  EXPECT_GE(told.trust, untold.trust - 0.03) << "an alias may hold a little for a moment";
  EXPECT_EQ(told.untracked, 0u);
  EXPECT_LT(told.mean_m, 0.05);
  EXPECT_GT(untold.mean_m, 0.1) << "the goods must pull, or nothing is shown";
}

TEST(TransientBeams, AreWeighedAllWhereTooFewWouldBeLeft) {
  LocalizerParams careful;
  careful.temporary = {.weighing = true, .least_share_left = 1.0};
  LocalizerParams off;
  off.temporary = {.weighing = false};
  EXPECT_EQ(driven(careful, true).mean_m, driven(off, true).mean_m);
  LocalizerParams on;
  on.temporary = {.weighing = true};
  EXPECT_NE(driven(on, true).mean_m, driven(off, true).mean_m);
}

}  // namespace
}  // namespace deltamap::localization::sensor
