// SPDX-License-Identifier: Apache-2.0
// What becomes of scans from while the write gate was shut: they vote late where the pose has held, and never where it
// has proven wrong.
#include "mapping/scan_set/waiting_scans.hpp"

#include <gtest/gtest.h>

#include <memory>

#include "mapping/map_update.hpp"
#include "mapping/map_update_params.hpp"
#include "mapping/store_scan.hpp"
#include "tests/mapping/straight_drive.hpp"
#include "tests/support/scans/drawn_scan.hpp"
#include "tests/support/scans/map_requests.hpp"
#include "tests/support/worlds/drawn_hall.hpp"

namespace deltamap::mapping::scan_set {
namespace {

TEST(WaitingScans, AreKeyframesOldestFirstOnTheMapOfNow) {
  WaitingScans waiting{{.moved_m = 0.149, .turned_rad = 1.0, .waited_s = 100.0}, 100};
  StraightDrive robot;
  for (int i = 0; i < 10; ++i) waiting.keep(robot.next());  // 5 cm each
  Estimate now;
  now.map = std::make_shared<const OccupancyGrid>();
  now.revision = 7;
  double last_m = 0.0;
  for (int i = 0; i < 4; ++i) {
    const auto scan = waiting.next(now);
    ASSERT_TRUE(scan);
    EXPECT_EQ(scan->estimate.map, now.map);
    EXPECT_EQ(scan->estimate.revision, 7U);
    if (i > 0) {
      EXPECT_NEAR(scan->odom_from_robot.x - last_m, 0.15, 1e-9);
    }
    last_m = scan->odom_from_robot.x;
  }
  EXPECT_TRUE(waiting.empty());
  EXPECT_FALSE(waiting.next(now));
}

TEST(WaitingScans, ForgetTheOldestWhereTheyAreTooMany) {
  WaitingScans waiting{{.moved_m = 0.01}, 5};
  StraightDrive robot;
  for (int i = 0; i < 20; ++i) waiting.keep(robot.next());
  EXPECT_NEAR(waiting.next({})->odom_from_robot.x, 0.05 * 16, 1e-9);
}

/// Drives past the hall's containers. After 12 s one goes, and for 4 s another place fits as well; from then on nothing
/// is in view.
class GoneWhileShut {
 public:
  void drive(double duration_s, const OccupancyGrid& world, bool is_unique, LocalizerState state) {
    for (const double end_s = time_s_ + duration_s; time_s_ < end_s; time_s_ += 0.2) {
      const Pose2 pose = test::below_the_containers(time_s_);
      TrackedScan tracked = test::drawn_scan(world, map, pose, time_s_, random_);
      tracked.estimate.state = state;
      tracked.estimate.belief.pose_right = is_unique ? 0.95 : 0.7;
      tracked.estimate.belief.stable = {100, 97, 1, 2};
      tracked.estimate.belief.other_share = is_unique ? 0.0 : 0.3;
      const auto set = test::set_in(store_.observe(tracked));
      shut_s += store_.awareness().gate == gate::GateReason::kOpen ? 0.0 : 0.2;
      if (!set) continue;
      const MapUpdate update = map_update(*map, *set, {});
      if (update.accepted()) map = std::make_shared<const OccupancyGrid>(patched(*map, update.changes));
    }
  }
  [[nodiscard]] std::size_t freed() const {
    std::size_t freed = 0;
    for (const CellChange& change : changes_between(before, *map)) freed += change.after == CellState::kFree ? 1 : 0;
    return freed;
  }

  const OccupancyGrid before = test::drawn_hall(0.05);
  std::shared_ptr<const OccupancyGrid> map = std::make_shared<const OccupancyGrid>(before);
  double shut_s = 0.0;

 private:
  StoreScan store_{StoreScanParams{}, 1};
  Random random_{5};
  double time_s_ = 0.0;
};

OccupancyGrid without_container(OccupancyGrid grid) {
  test::fill(grid, {8.0, 8.5}, {11.0, 10.0}, CellState::kFree);
  return grid;
}
const OccupancyGrid kNothingInView{{1, 1, 0.05, {0.0, 0.0}}};

TEST(WaitingScans, VoteOnceTheGateIsOpenAgain) {
  GoneWhileShut robot;
  robot.drive(12.0, robot.before, true, LocalizerState::kTracking);
  ASSERT_EQ(robot.freed(), 0U);
  robot.drive(4.0, without_container(robot.before), false, LocalizerState::kTracking);
  EXPECT_GT(robot.shut_s, 2.0);
  robot.drive(90.0, kNothingInView, true, LocalizerState::kTracking);
  EXPECT_GT(robot.freed(), 40U);
}

TEST(WaitingScans, NeverVoteOnceThePoseHasProvenWrong) {
  GoneWhileShut robot;
  robot.drive(12.0, robot.before, true, LocalizerState::kTracking);
  robot.drive(4.0, without_container(robot.before), false, LocalizerState::kTracking);
  robot.drive(0.2, kNothingInView, true, LocalizerState::kLost);
  robot.drive(90.0, kNothingInView, true, LocalizerState::kTracking);
  EXPECT_EQ(robot.freed(), 0U);
}

}  // namespace
}  // namespace deltamap::mapping::scan_set
