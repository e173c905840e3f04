// SPDX-License-Identifier: Apache-2.0
// A robot drives about a drawn room with a laser that is mounted otherwise than its scans say.
#include "navigation/mount_check.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/geometry/angle.hpp"
#include "tests/support/scans/cast_scan.hpp"
#include "tests/support/worlds/room_and_corridor.hpp"

namespace deltamap::navigation {
namespace {

constexpr double kLookPeriodS = 0.2;

/// Upside down, and as it is delivered: values come from the other side.
void mirror(Scan& scan) { std::reverse(scan.beams.begin(), scan.beams.end()); }

class Drive {
 public:
  double turned_rad = 0.0;  // of the laser, against what its scans say
  bool is_upside_down = false;
  double wheels_turn_more = 1.0;  // what the wheels tell of a turn
  bool in_doubt = true;

  /// A circle within the room, to the left or right.
  std::optional<OtherMount> circle(double turn_rate_rad_per_s, double for_s) {
    for (double t = 0.0; t < for_s; t += kLookPeriodS) {
      const Pose2 step{0.3 * kLookPeriodS, 0.0, turn_rate_rad_per_s * kLookPeriodS};
      map_from_robot_ = map_from_robot_ * step;
      odom_from_robot_ = odom_from_robot_ * Pose2{step.x, 0.0, wheels_turn_more * step.theta};
      look();
    }
    return check_.shown();
  }

 private:
  void look() {
    now_ += duration_from_seconds(kLookPeriodS);
    const Pose2 mount{0.1, 0.0, 0.0};
    Scan scan = test::cast_scan(world_, map_from_robot_, now_,
                                {.max_range_m = 8.0, .robot_from_laser = mount * Pose2{0.0, 0.0, turned_rad}}, noise_);
    scan.robot_from_laser = mount;
    if (is_upside_down) mirror(scan);
    check_.observe(scan, odom_from_robot_, 1, in_doubt);
  }

  OccupancyGrid world_ = test::room_with_pillar();
  Pose2 map_from_robot_{3.0, 3.0, 0.4};
  Pose2 odom_from_robot_;
  Random noise_{7};
  Timestamp now_ = timestamp_from_ns(1'000'000'000'000);
  MountCheck check_;
};

TEST(MountCheck, NamesALaserUpsideDown) {
  for (const double turn_rate : {0.3, -0.3}) {
    Drive drive;
    drive.is_upside_down = true;
    EXPECT_EQ(drive.circle(turn_rate, 60.0), OtherMount::kUpsideDown) << turn_rate;
  }
}

TEST(MountCheck, NamesALaserThatIsTurned) {
  for (const auto& [turned_deg, mount] : {std::pair{90.0, OtherMount::kTurnedLeft},
                                          {180.0, OtherMount::kTurnedRound},
                                          {-90.0, OtherMount::kTurnedRight}}) {
    Drive drive;
    drive.turned_rad = radians(turned_deg);
    EXPECT_EQ(drive.circle(0.3, 60.0), mount) << turned_deg;
  }
}

TEST(MountCheck, SaysNothingOfALaserThatIsMountedAsSet) {
  for (const double turn_rate : {0.3, -0.3, 0.6}) EXPECT_EQ(Drive{}.circle(turn_rate, 120.0), std::nullopt);
}

TEST(MountCheck, SaysNothingOfWheelsThatTellTurnsWrong) {
  Drive drive;
  drive.wheels_turn_more = 1.5;
  EXPECT_EQ(drive.circle(0.3, 120.0), std::nullopt);
}

TEST(MountCheck, TakesAWordBackOnceTheLaserIsMountedAsSet) {
  Drive drive;
  drive.is_upside_down = true;
  EXPECT_EQ(drive.circle(0.3, 60.0), OtherMount::kUpsideDown);
  drive.is_upside_down = false;
  EXPECT_EQ(drive.circle(0.3, 60.0), std::nullopt);
}

TEST(MountCheck, LooksOnlyAtWaysThatAreInDoubt) {
  Drive drive;
  drive.is_upside_down = true;
  drive.in_doubt = false;
  EXPECT_EQ(drive.circle(0.3, 60.0), std::nullopt);
  drive.in_doubt = true;
  EXPECT_EQ(drive.circle(0.3, 60.0), OtherMount::kUpsideDown);
}

}  // namespace
}  // namespace deltamap::navigation
