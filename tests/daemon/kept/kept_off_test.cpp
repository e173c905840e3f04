// SPDX-License-Identifier: Apache-2.0
// What an operator switched off in the running daemon: whether it is kept, and for which robot.
#include "daemon/kept/kept_drive.hpp"
#include "tests/support/daemon/control_fixture.hpp"

namespace deltamap::daemon {
namespace {

using control::Request;
using test::comes_true;
using test::content_of;
using test::DriveTest;
using Json = nlohmann::json;

class KeptOffTest : public DriveTest {};

TEST_F(KeptOffTest, AnOffThatIsNotKeptOnDiskIsNotAnsweredAsDone) {
  settings_.navigation.mode = navigation::DriveMode::kWander;
  settings_.map.store = folder_.path() / "kept.sqlite";
  const auto file = drive_place(settings_.map.store, settings_.robot.port).file;
  const std::filesystem::path in_the_way = file.string() + ".part";
  run([&](test::SimulatedPorts& ports) {
    EXPECT_EQ(asked({Request::Kind::kDriveWander, {}})["ok"], true);
    EXPECT_TRUE(comes_true([&] { return moves(ports); }));
    std::filesystem::create_directories(in_the_way / "something");
    const Json reply = asked({Request::Kind::kDriveOff, {}});
    EXPECT_EQ(reply["ok"], false);
    const std::string error = reply.value("error", "");
    EXPECT_NE(error.find("the robot is told to stand. The off is NOT kept on disk: "), std::string::npos) << reply;
    EXPECT_TRUE(comes_true([&] { return status()["stopped_by"] == "no command"; })) << "it stands all the same";
    EXPECT_EQ(status()["drive"], "off");
    std::filesystem::remove_all(in_the_way);
    EXPECT_TRUE(comes_true([&] { return content_of(file).find("off by the operator") != std::string::npos; }))
        << "tried again by itself";
    EXPECT_EQ(asked({Request::Kind::kDriveOff, {}})["ok"], true);
  });
}

TEST_F(KeptOffTest, WhatWasSwitchedOffWithAnotherMapStaysOff) {
  settings_.navigation.mode = navigation::DriveMode::kWander;
  settings_.map.store = folder_.path() / "east.sqlite";
  run([&](test::SimulatedPorts&) { EXPECT_EQ(asked({Request::Kind::kDriveWander, {}})["ok"], true); });
  settings_.map.store = folder_.path() / "west.sqlite";
  run([&](test::SimulatedPorts&) { EXPECT_EQ(asked({Request::Kind::kDriveOff, {}})["ok"], true); });
  settings_.map.store = folder_.path() / "east.sqlite";
  run([&](test::SimulatedPorts& ports) {
    const int scan = status()["localized"];
    EXPECT_TRUE(reached_scan(scan + 10));
    EXPECT_FALSE(moves(ports));
    EXPECT_EQ(status()["drive_switch"], "off by the operator");
  });
}

}  // namespace
}  // namespace deltamap::daemon
