// SPDX-License-Identifier: Apache-2.0
// The drive in virtual time: repeatable, true to its truth, and honest about what odometry cannot see.
#include "simulation/virtual_drive.hpp"
#include "tests/support/files/source_tree.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace deltamap::simulation {
namespace {

Scenario delivered_hall() { return read_scenario(test::source_path("config/scenarios/hall.yaml")); }

Scenario hall_of_exact_laser() {
  Scenario scenario = delivered_hall();
  scenario.laser.optics.range_noise_m = 0.0;
  scenario.laser.optics.dropout_share = 0.0;
  scenario.laser.optics.mixed_share = 0.0;
  return scenario;
}

bool same(const DriveStep& a, const DriveStep& b) {
  if (!(a.map_from_robot == b.map_from_robot) || a.odometry.size() != b.odometry.size()) return false;
  for (std::size_t i = 0; i < a.odometry.size(); ++i) {
    if (!(a.odometry[i].odom_from_robot == b.odometry[i].odom_from_robot)) return false;
    if (a.odometry[i].time != b.odometry[i].time) return false;
  }
  for (std::size_t i = 0; i < a.scan.beams.size(); ++i) {
    if (a.scan.beams[i].range_m != b.scan.beams[i].range_m || a.scan.beams[i].kind != b.scan.beams[i].kind)
      return false;
  }
  return a.scan.time == b.scan.time && a.changes.size() == b.changes.size();
}

Pose2 odometry_after(VirtualDrive& drive) { return drive.next().odometry.back().odom_from_robot; }

TEST(VirtualDrive, GivesTheSameMessagesForTheSameSeed) {
  VirtualDriveParams params;
  params.seed = 7;
  params.forklift = ForkliftParams{.change_every_s = 5.0};
  VirtualDrive one{delivered_hall(), params};
  VirtualDrive other{delivered_hall(), params};
  for (int scan = 0; scan < 300; ++scan) ASSERT_TRUE(same(one.next(), other.next())) << "scan " << scan;
}

TEST(VirtualDrive, GivesOtherMessagesForAnotherSeed) {
  VirtualDrive one{delivered_hall(), {.seed = 1}};
  VirtualDrive other{delivered_hall(), {.seed = 2}};
  EXPECT_FALSE(same(one.next(), other.next()));
}

TEST(VirtualDrive, MeasuresFromWhereItTrulyIs) {
  VirtualDrive drive{hall_of_exact_laser(), {.max_range_m = 80.0}};
  for (int scan = 0; scan < 400; ++scan) {
    const RayCaster surfaces{drive.world()};
    const DriveStep step = drive.next();
    const Pose2 map_from_laser = step.map_from_robot * step.scan.robot_from_laser;
    int off = 0;
    for (std::size_t beam = 0; beam < step.scan.beams.size(); ++beam) {
      constexpr double kTurnInASweep_rad = 0.006;
      constexpr double kWayInASweep_m = 0.02;
      const double bearing = map_from_laser.theta + step.scan.bearing_rad(beam);
      const auto range_m = [&](double turned_rad) {
        return surfaces.cast(map_from_laser.position(), bearing + turned_rad, 80.0)->range_m;
      };
      const auto [least, most] = std::minmax({range_m(-kTurnInASweep_rad), range_m(0.0), range_m(kTurnInASweep_rad)});
      const double measured_m = step.scan.beams[beam].range_m;
      if (measured_m < least - kWayInASweep_m || measured_m > most + kWayInASweep_m) ++off;
    }
    EXPECT_LE(off, 3) << "scan " << scan;  // past an edge
  }
}

TEST(VirtualDrive, CallsWhatLiesFartherBeyondMaximum) {
  VirtualDrive drive{hall_of_exact_laser(), {.max_range_m = 8.0}};
  const DriveStep step = drive.next();  // in the corner (2.5, 2.5), looking along a corridor of 35 m
  EXPECT_EQ(step.scan.beams[90].kind, BeamKind::kBeyondMaximum);
  EXPECT_EQ(step.scan.beams[0].kind, BeamKind::kRange);
  EXPECT_NEAR(step.scan.beams[0].range_m, 2.5, 0.01);
}

TEST(VirtualDrive, ComesAboutTheWholeHallWithoutTouchingAnything) {
  VirtualDrive drive{delivered_hall(), {.seed = 3}};
  std::array<bool, 4> quarters{};
  int stalled = 0;
  double driven_m = 0.0;
  Pose2 last = drive.map_from_robot();
  for (int scan = 0; scan < 8000; ++scan) {
    const DriveStep step = drive.next();
    for (const Odometry& odometry : step.odometry) stalled += odometry.stalled ? 1 : 0;
    quarters.at((step.map_from_robot.x > 17.5 ? 1 : 0) + (step.map_from_robot.y > 17.5 ? 2 : 0)) = true;
    driven_m += distance_between(last, step.map_from_robot);
    last = step.map_from_robot;
  }
  EXPECT_EQ(stalled, 0);
  EXPECT_GT(driven_m, 300.0);
  for (const bool been : quarters) EXPECT_TRUE(been);
}

TEST(VirtualDrive, GetsAlongWithPeopleAndAForkLift) {
  VirtualDriveParams params;
  params.seed = 8;
  params.forklift = ForkliftParams{.change_every_s = 20.0};
  VirtualDrive drive{read_scenario(test::source_path("config/scenarios/depot.yaml")), params};
  double driven_m = 0.0;
  double least_room_m = 10.0;
  std::size_t changes = 0;
  Pose2 last = drive.map_from_robot();
  for (int scan = 0; scan < 5600; ++scan) {
    const DriveStep step = drive.next();
    changes += step.changes.size();
    for (const Circle& person : drive.movers().bodies().walkers()) {
      least_room_m = std::min(least_room_m, (person.centre - step.map_from_robot.position()).norm());
    }
    driven_m += distance_between(last, step.map_from_robot);
    last = step.map_from_robot;
  }
  EXPECT_GE(changes, 20u);
  EXPECT_GT(driven_m, 150.0);    // of 298 m without anyone in the way
  EXPECT_GT(least_room_m, 0.4);  // between centres; bodies touch at 0.45, walked into by the person
}

TEST(VirtualDrive, DoesNotTellOdometryOfAKidnap) {
  VirtualDrive drive{delivered_hall(), {.seed = 4}};
  for (int scan = 0; scan < 100; ++scan) (void)drive.next();
  const Pose2 before = odometry_after(drive);
  const Pose2 true_before = drive.map_from_robot();
  drive.kidnap({32.5, 20.0, 1.0});
  const Pose2 after = odometry_after(drive);
  EXPECT_LT(distance_between(before, after), 0.1);
  EXPECT_GT(distance_between(true_before, drive.map_from_robot()), 10.0);
  for (int scan = 0; scan < 300; ++scan) EXPECT_TRUE(drive.is_free(drive.next().map_from_robot.position())) << scan;
}

TEST(VirtualDrive, LetsTheBodySlipUnderSilentWheelsAndTheWheelsSpinUnderAStandingBody) {
  VirtualDrive drive{delivered_hall(), {.seed = 5}};
  const Pose2 odometry_before = odometry_after(drive);
  const Pose2 before = drive.map_from_robot();
  drive.slip({0.4, 0.1, 0.1});
  EXPECT_NEAR(distance_between(before, drive.map_from_robot()), std::hypot(0.4, 0.1), 1e-9);
  EXPECT_LT(distance_between(odometry_before, odometry_after(drive)), 0.1);
  const Pose2 standing = drive.map_from_robot();
  const Pose2 rolled = odometry_after(drive);
  drive.spin({0.5, 0.0, 0.0});
  EXPECT_LT(distance_between(standing, drive.map_from_robot()), 0.1);
  EXPECT_GT(distance_between(rolled, odometry_after(drive)), 0.4);
}

TEST(VirtualDrive, ShowsPeopleInTheScans) {
  VirtualDriveParams params;
  params.people.push_back({.path = {{4.5, 2.5}, {6.0, 2.5}}, .walk_least_s = 100.0, .walk_most_s = 200.0});
  VirtualDrive with{hall_of_exact_laser(), params};
  EXPECT_NEAR(with.next().scan.beams[90].range_m, 2.0 - 0.2 - 0.021, 0.02);
}

TEST(VirtualDrive, ShowsAChangeInTheNextScan) {
  VirtualDrive drive{hall_of_exact_laser(), {}};
  EXPECT_GT(drive.next().scan.beams[90].range_m, 30.0);
  drive.change({ChangeKind::kAdded, 999, Box{{10.0, 2.5}, 1.0, 1.0, 0.0}, std::nullopt});
  EXPECT_NEAR(drive.next().scan.beams[90].range_m, 9.5 - 2.521, 0.1);
}

TEST(VirtualDrive, ChangesTheWantedShareOfTheSlotsAtOnce) {
  VirtualDrive drive{delivered_hall(), {.seed = 6}};
  ForkliftParams forklift;
  forklift.kinds = {ChangeKind::kRemoved, ChangeKind::kAdded, ChangeKind::kShifted};
  forklift.least_filled = 0.3;
  const Scenario before = delivered_hall();
  EXPECT_GE(drive.change_many(0.5, forklift).size(), 32u);
  const auto stands_at = [&](const Box& slot) {
    return std::any_of(drive.world().objects.begin(), drive.world().objects.end(), [&](const Object& object) {
      const Box* box = std::get_if<Box>(&object.shape);
      return box != nullptr && (box->centre - slot.centre).norm() < 0.01;
    });
  };
  const auto kept = std::count_if(before.slots.begin(), before.slots.end(), stands_at);
  EXPECT_EQ(kept, 32);
}

TEST(VirtualDrive, GoesItsRoundAgainAndAgain) {
  VirtualDriveParams params;
  params.route.round = {{10.0, 2.5}, {2.5, 2.5}};
  VirtualDrive drive{delivered_hall(), params};
  constexpr double kNear_m = 0.8;
  std::vector<std::size_t> visited;
  for (int scan = 0; scan < 900; ++scan) {
    const Point2 at = drive.next().map_from_robot.position();
    EXPECT_NEAR(at.y(), 2.5, kNear_m);
    for (std::size_t i = 0; i < params.route.round.size(); ++i) {
      const bool is_there = (at - params.route.round[i]).norm() < kNear_m;
      if (is_there && (visited.empty() || visited.back() != i)) visited.push_back(i);
    }
  }
  EXPECT_EQ(visited, (std::vector<std::size_t>{1, 0, 1, 0, 1, 0}));
}

TEST(VirtualDrive, DrivesWhatItIsHeldTo) {
  VirtualDrive drive{delivered_hall(), {}};
  drive.hold({.turn_rate_rad_per_s = 0.5});
  double turned_rad = 0.0;
  double heading_rad = drive.map_from_robot().theta;
  for (int scan = 0; scan < 100; ++scan) {
    (void)drive.next();
    turned_rad += turn_between(heading_rad, drive.map_from_robot().theta);
    heading_rad = drive.map_from_robot().theta;
  }
  EXPECT_NEAR(turned_rad, 0.5 * 100 * VirtualDriveParams{}.scan_period_s, 0.3);
  EXPECT_NEAR((drive.map_from_robot().position() - delivered_hall().robot.map_from_start.position()).norm(), 0.0, 0.05);
}

}  // namespace
}  // namespace deltamap::simulation
