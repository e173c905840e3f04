// SPDX-License-Identifier: Apache-2.0
// The simulator against the sessions that will meet the real devices, in virtual time.
#include "simulation/simulation.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/simulation/simulation_host.hpp"

namespace deltamap::simulation {
namespace {

namespace pioneer = drivers::pioneer;

TEST(Simulation, BringsBothSessionsUpAndStreams) {
  Host host{delivered("demo"), 1};
  host.run_for(15.0);
  EXPECT_EQ(host.failure, "");
  EXPECT_TRUE(host.robot_session.is_connected());
  EXPECT_TRUE(host.laser_session.is_streaming());
  const std::size_t scans_before = host.scans.size();
  const std::size_t sips_before = host.odometry.size();
  host.run_for(10.0);
  EXPECT_NEAR(static_cast<double>(host.scans.size() - scans_before), 10.0 / (8 * 0.02664), 1.5) << "B7: every 8th";
  EXPECT_NEAR(static_cast<double>(host.odometry.size() - sips_before), 100.0, 2.0);
  EXPECT_EQ(host.robot_session.counts().errors(), 0u);
}

TEST(Simulation, MovesTheRobotAsTheSessionDrivesIt) {
  Host host{delivered("hall"), 2};
  host.run_for(10.0);
  for (int i = 0; i < 100; ++i) {
    host.drive(0.4, 0.0);
    host.run_for(0.1);
  }
  const Pose2 truth = host.simulation.map_from_robot();
  EXPECT_GT(truth.x, 2.5 + 3.0);
  const Odometry& last = host.odometry.back();
  EXPECT_NEAR(last.odom_from_robot.x, truth.x - 2.5, 0.12) << "wheel errors of some per mille, slip, 0.1 s of age";
  EXPECT_NEAR(last.speed_m_per_s, 0.4, 0.01);
}

TEST(Simulation, LetsANewProgramTakeOverDevicesThatACrashedOneLeftRunning) {
  Host host{delivered("hall"), 6};
  host.run_for(12.0);
  host.drive(0.4, 0.0);
  host.run_for(1.0);
  ASSERT_GT(host.simulation.map_from_robot().x, 2.6);
  host.restart_sessions();
  host.run_for(1.0);
  const Pose2 stopped = host.simulation.map_from_robot();
  host.run_for(14.0);
  EXPECT_EQ(host.failure, "");
  EXPECT_TRUE(host.robot_session.is_connected());
  EXPECT_TRUE(host.laser_session.is_streaming());
  EXPECT_LT(deltamap::distance_between(stopped, host.simulation.map_from_robot()), 0.3)
      << "it does not drive on at the set points of the dead program";
}

TEST(Simulation, StopsByItsWatchdogWhenTheHostFallsSilent) {
  Host host{delivered("hall"), 6};
  host.run_for(12.0);
  host.drive(0.4, 0.0);
  host.run_for(1.0);
  Simulation& alone = host.simulation;
  alone.advance_to(alone.now() + std::chrono::milliseconds{4500});
  const Pose2 stopped = alone.map_from_robot();
  EXPECT_TRUE(alone.robot().watchdog_has_fired());
  alone.advance_to(alone.now() + std::chrono::seconds{2});
  EXPECT_EQ(alone.map_from_robot(), stopped);
  alone.send_to_robot(pioneer::encoded_command({pioneer::CommandNumber::kPulse, {}}), 9600);
  alone.advance_to(alone.now() + std::chrono::seconds{1});
  EXPECT_GT(alone.map_from_robot().x, stopped.x + 0.1) << "and one pulse lets it drive on";
}

TEST(Simulation, StampsEachScanWithTheTimeAtWhichTheTruthWasTaken) {
  for (const unsigned baud : {38400u, 500000u}) {
    Host host{delivered("hall"), 3, baud};
    host.run_for(12.0);
    std::vector<Timestamp> first_beams;
    for (const TruthRecord& record : host.truth) {
      const auto* pose = std::get_if<TruthPose>(&record);
      if (pose != nullptr && pose->at_scan) first_beams.push_back(pose->time);
    }
    ASSERT_FALSE(host.scans.empty());
    for (const Scan& scan : host.scans) {
      const auto after =
          std::lower_bound(first_beams.begin(), first_beams.end(), scan.time - std::chrono::milliseconds{5});
      ASSERT_NE(after, first_beams.end());
      EXPECT_NEAR(seconds(scan.time - *after), 0.0, 0.0012) << "baud " << baud;
    }
  }
}

TEST(Simulation, MeasuresTheWallsWhereTheyAreWhileTheRobotTurns) {
  Scenario scenario = delivered("hall");
  scenario.forklift.reset();
  scenario.laser.optics.dropout_share = 0.0;
  scenario.laser.optics.mixed_share = 0.0;
  Host host{scenario, 4};
  host.run_for(10.0);
  const std::size_t first = host.scans.size();
  for (int i = 0; i < 50; ++i) {
    host.drive(0.2, 0.8);
    host.run_for(0.1);
  }
  // Each beam from the true pose at its own time ends on a surface.
  Truth truth;
  for (const TruthRecord& record : host.truth) {
    if (const auto* pose = std::get_if<TruthPose>(&record)) truth.poses.push_back(*pose);
  }
  std::stable_sort(truth.poses.begin(), truth.poses.end(),
                   [](const auto& a, const auto& b) { return a.time < b.time; });
  const Pose2 robot_from_laser = scenario.laser.optics.robot_from_laser;
  int near = 0;
  int all = 0;
  for (std::size_t i = first; i < host.scans.size(); ++i) {
    const Scan& scan = host.scans[i];
    for (std::size_t beam = 0; beam < scan.beams.size(); beam += 10) {
      if (scan.beams[beam].kind != BeamKind::kRange) continue;
      const Pose2 map_from_robot =
          pose_at(truth, scan.time + duration_from_seconds(static_cast<double>(scan.beams[beam].offset_s)));
      const double bearing = scan.bearing_rad(beam);
      const double range = static_cast<double>(scan.beams[beam].range_m);
      const Point2 hit =
          map_from_robot * robot_from_laser * Point2{range * std::cos(bearing), range * std::sin(bearing)};
      double distance = 1e9;
      for (const Object& object : scenario.world.objects) {
        distance = std::min(distance, distance_to_surface(hit, object.shape));
      }
      ++all;
      near += distance < 0.05 ? 1 : 0;
    }
  }
  ASSERT_GT(all, 500);
  EXPECT_GT(static_cast<double>(near) / all, 0.97) << "uncorrected, 0.8 rad/s over 27 ms would be 0.2 m at 10 m";
}

TEST(Simulation, RepeatsFromItsSeedToTheLastByte) {
  const auto truth_of = [](std::uint64_t seed) {
    Host host{delivered("demo"), seed};
    host.run_for(8.0);
    for (int i = 0; i < 100; ++i) {
      host.drive(0.3, 0.1);
      host.run_for(0.1);
    }
    std::string lines;
    for (const TruthRecord& record : host.truth) lines += truth_line(record) + "\n";
    return lines;
  };
  const std::string first = truth_of(7);
  EXPECT_EQ(first, truth_of(7));
  EXPECT_NE(first, truth_of(8));
}

TEST(Simulation, ChangesTheWorldOnScheduleAndTellsTheTruth) {
  Simulation simulation{delivered("hall"), {5, kStart, 10.0}};
  int changes = 0;
  World rebuilt = delivered("hall").world;
  for (int s = 1; s <= 100; ++s) {
    simulation.advance_to(kStart + std::chrono::seconds{s});
    for (const TruthRecord& record : simulation.take_truth()) {
      if (const auto* change = std::get_if<TruthChange>(&record)) {
        ++changes;
        rebuilt = changed(rebuilt, change->change);
      }
    }
  }
  EXPECT_GE(changes, 8);
  EXPECT_LE(changes, 10);
  EXPECT_EQ(rebuilt.objects.size(), simulation.world().objects.size());
}

}  // namespace
}  // namespace deltamap::simulation
