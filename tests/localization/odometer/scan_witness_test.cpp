// SPDX-License-Identifier: Apache-2.0
#include "localization/odometer/scan_witness.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <deque>

#include "localization/motion/deskew.hpp"
#include "tests/support/scans/cast_scan.hpp"
#include "tests/support/worlds/room_and_corridor.hpp"

namespace deltamap::localization::odometer {
namespace {

constexpr double kScanS = 0.2;
constexpr int kReports = 4;  // a scan

/// A robot in a room; each scan comes after the reports up to then.
class WitnessInTheRoom : public testing::Test {
 protected:
  LaserMotion step(const Pose2& done, const Pose2& claimed) {
    for (int k = 1; k <= kReports; ++k) {
      const double share = static_cast<double>(k) / kReports;
      Odometry report;
      report.time = time + duration_from_seconds(share * kScanS + lag_s);
      report.odom_from_robot = counted * Pose2{share * claimed.x, share * claimed.y, share * claimed.theta};
      reports.push_back(report);
    }
    counted = counted * claimed;
    truth = truth * done;
    time = time + duration_from_seconds(kScanS);
    while (!reports.empty() && reports.front().time <= time) {
      wheels.add(reports.front());
      as_they_came.add(reports.front());
      reports.pop_front();
    }
    const Scan scan = test::cast_scan(world, truth, time, {}, random);
    return witness.observe(scan, motion::deskewed(scan, {}), wheels, as_they_came);
  }
  LaserMotion step(const Pose2& done) { return step(done, done); }
  [[nodiscard]] Pose2 off() const {
    return motion_between(motion_between(kStart, truth), wheels.at(time)->continuous_odom_from_robot);
  }

  const Pose2 kStart{2.0, 3.0, 0.0};
  OccupancyGrid world = test::room_with_pillar();
  Random random{5};
  motion::OdometryBuffer wheels{{}};
  motion::OdometryBuffer as_they_came{{}};
  ScanWitness witness;
  std::deque<Odometry> reports;  // not yet told
  Pose2 truth = kStart;
  Pose2 counted;
  Timestamp time = timestamp_from_ns(1'700'000'000'000'000'000);
  double lag_s = 0.0;
};

TEST_F(WitnessInTheRoom, CorrectsTheReportsWhereTheWheelsSlip) {
  const Pose2 forward{0.08, 0.0, 0.0};
  for (int i = 0; i < 10; ++i) (void)step(forward);
  EXPECT_TRUE(step(forward, forward * Pose2{0.0, 0.0, radians(20.0)}).slip);
  for (int i = 0; i < 10; ++i) (void)step(forward);
  EXPECT_LT(std::abs(off().theta), radians(2.0));
  EXPECT_LT(off().position().norm(), 0.1);
}

TEST_F(WitnessInTheRoom, TakesOutHowLateTheReportsAre) {
  lag_s = 0.15;
  EXPECT_FALSE(witness.lag_s());
  for (int i = 0; i < 120; ++i) (void)step({0.02, 0.0, (i / 10) % 2 == 0 ? 0.12 : -0.12});
  ASSERT_TRUE(witness.lag_s());
  EXPECT_NEAR(*witness.lag_s(), lag_s, 0.02);
}

}  // namespace
}  // namespace deltamap::localization::odometer
