// SPDX-License-Identifier: Apache-2.0
// Who may drive: what `ctl drive` is answered, and when the simulated robot moves.
#include "daemon/kept/kept_drive.hpp"
#include "tests/support/daemon/control_fixture.hpp"

namespace deltamap::daemon {
namespace {

using control::Request;
using test::comes_true;
using test::content_of;
using test::DriveTest;
using Json = nlohmann::json;

TEST_F(DriveTest, WhereTheSettingsSayOffNothingEnablesTheMotors) {
  run([&](test::SimulatedPorts& ports) {
    const Json refused = asked({Request::Kind::kDriveWander, {}});
    EXPECT_EQ(refused["ok"], false);
    EXPECT_EQ(refused["error"], "'navigation.mode' is off: this daemon never drives (set it to wander, and restart)");
    EXPECT_EQ(asked({Request::Kind::kDriveOff, {}})["ok"], true);
    const int scan = status()["localized"];
    EXPECT_TRUE(reached_scan(scan + 10));
    EXPECT_FALSE(moves(ports));
    EXPECT_EQ(status()["drive"], "off");
    EXPECT_EQ(status()["stopped_by"], "no command");
  });
}

TEST_F(DriveTest, WithoutAPoseItStandsAndSaysWhy) {
  settings_.navigation.mode = navigation::DriveMode::kWander;
  settings_.initial_pose.reset();
  run([&](test::SimulatedPorts& ports) {
    EXPECT_EQ(asked({Request::Kind::kDriveWander, {}})["ok"], true);
    EXPECT_TRUE(comes_true([&] { return status()["stopped_by"] == "pose unknown"; }));
    const std::size_t from = ports.commands().size();
    const int scan = status()["localized"];
    EXPECT_TRUE(reached_scan(scan + 10));
    EXPECT_FALSE(moves(ports, from));
  });
}

TEST_F(DriveTest, WithoutAPoseItDrivesWhereTheSettingsSaySo) {
  settings_.navigation.mode = navigation::DriveMode::kWander;
  settings_.navigation.drive_without_pose = true;
  settings_.initial_pose.reset();
  run([&](test::SimulatedPorts& ports) {
    EXPECT_EQ(asked({Request::Kind::kDriveWander, {}})["ok"], true);
    EXPECT_TRUE(comes_true([&] { return status()["stopped_by"] == "none"; }));
    EXPECT_TRUE(comes_true([&] { return moves(ports); }));
  });
}

TEST_F(DriveTest, BeforeTheWatchdogIsKnownWanderSaysWhatItWaitsForAndDrivesThen) {
  settings_.navigation.mode = navigation::DriveMode::kWander;
  const auto prepare = [](test::SimulatedPorts& ports) { ports.hear_config(false); };
  run(
      [&](test::SimulatedPorts& ports) {
        const Json reply = asked({Request::Kind::kDriveWander, {}});
        EXPECT_EQ(reply["ok"], true) << reply;
        EXPECT_EQ(reply["message"], "wanders once the robot has told its watchdog");
        EXPECT_FALSE(moves(ports));
        ports.hear_config(true);
        EXPECT_TRUE(comes_true([&] { return moves(ports); }));
        EXPECT_EQ(asked({Request::Kind::kDriveWander, {}})["message"], "wanders from the next scan on");
      },
      prepare, 0);  // it is asked for five seconds
}

TEST_F(DriveTest, ARobotThatDoesNotTellItsWatchdogIsRefused) {
  settings_.navigation.mode = navigation::DriveMode::kWander;
  const auto prepare = [](test::SimulatedPorts& ports) { ports.hear_config(false); };
  run(
      [&](test::SimulatedPorts& ports) {
        // The session asks five times before it gives up.
        EXPECT_TRUE(comes_true([&] { return asked({Request::Kind::kDriveWander, {}})["ok"] == false; }));
        const Json reply = asked({Request::Kind::kDriveWander, {}});
        EXPECT_EQ(reply["error"], "it is not driven: the robot does not tell its watchdog");
        EXPECT_FALSE(moves(ports));
      },
      prepare);
}

TEST_F(DriveTest, ARobotOfAnUnknownSubtypeIsWarnedOfAndRefusedUntilHullAndUnitAreSet) {
  scenario_ = simulation::with_robot(scenario_, "p3at");
  settings_.navigation.mode = navigation::DriveMode::kWander;
  const std::string why =
      "its subtype \"p3at\" is unknown: set its hull (navigation.safety.robot_radius_m) and its unit "
      "(robot.distance_unit_mm) by hand";
  run([&](test::SimulatedPorts& ports) {
    EXPECT_EQ(asked({Request::Kind::kDriveWander, {}})["error"], "it is not driven: " + why);
    EXPECT_EQ(status()["never_driven"], why);
    const int scan = status()["localized"];
    EXPECT_TRUE(reached_scan(scan + 10));
    EXPECT_FALSE(moves(ports));
  });
  settings_.robot.session.by_hand = {0.000465, 0.5};
  run([&](test::SimulatedPorts&) {
    EXPECT_EQ(status()["never_driven"], "");
    EXPECT_EQ(asked({Request::Kind::kDriveWander, {}})["ok"], true);
  });
}

TEST_F(DriveTest, AWordToAMissingRobotDoesNotMakeItPresent) {
  settings_.navigation.mode = navigation::DriveMode::kWander;
  run([&](test::SimulatedPorts& ports) {
    ASSERT_TRUE(comes_true([&] { return status()["ports"]["robot"] == "up"; }));
    ports.unplug_robot();
    ASSERT_TRUE(comes_true([&] { return status()["ports"]["robot"] == "down"; }));
    EXPECT_EQ(asked({Request::Kind::kDriveWander, {}})["message"], "wanders once the robot is connected");
    EXPECT_EQ(status()["ports"]["robot"], "down");
    EXPECT_TRUE(comes_true([&] { return status()["stopped_by"] == "no odometry"; }));
  });
}

TEST_F(DriveTest, AStatusTellsThatARobotIsGoneWhichWasDriving) {
  settings_.navigation.mode = navigation::DriveMode::kWander;
  run([&](test::SimulatedPorts& ports) {
    EXPECT_EQ(asked({Request::Kind::kDriveWander, {}})["ok"], true);
    ASSERT_TRUE(comes_true([&] { return status()["told"]["speed_m_per_s"] > 0.0; }));
    ports.unplug_robot();
    ASSERT_TRUE(comes_true([&] { return status()["stopped_by"] == "no odometry"; }));
    EXPECT_EQ(status()["told"]["speed_m_per_s"], 0.0);
    EXPECT_EQ(status()["told"]["turn_rate_rad_per_s"], 0.0);
  });
}

TEST_F(DriveTest, ARefusedWanderDoesNotSwitchOn) {
  settings_.navigation.mode = navigation::DriveMode::kWander;
  settings_.navigation.safety.low_battery_s = 0.2;
  run([&](test::SimulatedPorts& ports) {
    ports.drain_battery();
    EXPECT_TRUE(comes_true([&] { return status()["stopped_by"] == "low battery"; }));
    EXPECT_EQ(asked({Request::Kind::kDriveWander, {}})["ok"], false);
    EXPECT_EQ(status()["drive_switch"], "unknown") << "else it would drive later, by itself";
    EXPECT_FALSE(moves(ports));
  });
}

TEST_F(DriveTest, OffStopsTheRobotAndWanderStartsItAgain) {
  settings_.navigation.mode = navigation::DriveMode::kWander;
  settings_.map.store = folder_.path() / "kept.sqlite";
  const auto kept = [&] { return content_of(drive_place(settings_.map.store, settings_.robot.port).file); };
  run([&](test::SimulatedPorts& ports) {
    EXPECT_FALSE(moves(ports)) << "nobody has said anything yet";
    EXPECT_EQ(status()["drive"], "off");
    EXPECT_EQ(status()["drive_switch"], "unknown");
    EXPECT_EQ(asked({Request::Kind::kDriveWander, {}})["ok"], true);
    EXPECT_TRUE(comes_true([&] { return moves(ports); }));
    EXPECT_EQ(kept(), "{\"drive\":\"on\",\"robot_port\":\"/dev/ttyUSB0\"}\n");
    EXPECT_EQ(asked({Request::Kind::kDriveOff, {}})["ok"], true);
    EXPECT_EQ(kept(), "{\"drive\":\"off by the operator\",\"robot_port\":\"/dev/ttyUSB0\"}\n")
        << "on disk when it is answered";
    EXPECT_TRUE(comes_true([&] { return status()["stopped_by"] == "no command"; }));
    EXPECT_EQ(status()["drive"], "off");
    const std::size_t stopped = ports.commands().size();
    const int scan = status()["localized"];
    EXPECT_TRUE(reached_scan(scan + 10));
    EXPECT_FALSE(moves(ports, stopped)) << "the pilot is not listened to";
    EXPECT_EQ(asked({Request::Kind::kDriveWander, {}})["ok"], true);
    EXPECT_TRUE(comes_true([&] { return moves(ports, stopped); }));
    EXPECT_EQ(status()["drive"], "wander");
    EXPECT_EQ(asked({Request::Kind::kDriveOff, {}})["ok"], true);
  });
  run([&](test::SimulatedPorts& ports) {
    const int scan = status()["localized"];
    EXPECT_TRUE(reached_scan(scan + 10));
    EXPECT_FALSE(moves(ports)) << "a restart is no person";
    EXPECT_EQ(status()["drive_switch"], "off by the operator");
  });
}

}  // namespace
}  // namespace deltamap::daemon
