// SPDX-License-Identifier: Apache-2.0
// An output never takes the place of the first map, of the settings or of another output; two devices have two ports.
#include "daemon/settings/run_contradictions.hpp"

#include <gtest/gtest.h>

#include "core/files/grid_file.hpp"
#include "daemon/settings/settings_reading.hpp"
#include "tests/support/files/temporary_folder.hpp"
#include "tests/support/files/text_file.hpp"

namespace deltamap::daemon {
namespace {

namespace fs = std::filesystem;

class RunContradictions : public testing::Test {
 protected:
  void SetUp() override {
    write_grid(OccupancyGrid{{3, 2, 0.05, {0.0, 0.0}}, CellState::kFree}, in("m0.yaml"));
    fs::rename(in("m0.pgm"), in("hall.pgm"));
    std::string text = test::content_of(in("m0.yaml"));
    text.replace(text.find("m0.pgm"), 6, "hall.pgm");
    (void)folder_.write("m0.yaml", text);
  }
  [[nodiscard]] std::string in(const std::string& name) const { return folder_.path() / name; }

  /// Without the place, which the tests of settings look at.
  [[nodiscard]] std::vector<std::string> told(const std::vector<std::string>& overrides) const {
    std::vector<std::string> all{"map.file=" + in("m0.yaml")};
    all.insert(all.end(), overrides.begin(), overrides.end());
    std::vector<std::string> lines = look_at_settings(settings_, all).problems;
    for (std::string& line : lines) line.erase(0, line.find(": ") + 2);
    return lines;
  }

  test::TemporaryFolder folder_;
  fs::path settings_ = folder_.write("robot.yaml", "seed: 1\n");
};

using Lines = std::vector<std::string>;

TEST_F(RunContradictions, NoOutputTakesThePlaceOfWhatIsRead) {
  for (const std::string key : {"map.store", "recording.file", "control.socket", "poses.socket"}) {
    EXPECT_EQ(told({key + "=" + in("m0.yaml")}), Lines{key + ": must not be the same file as 'map.file'"});
    EXPECT_EQ(told({key + "=" + in("hall.pgm")}),
              Lines{key + ": must not be the same file as the image of 'map.file'"});
    EXPECT_EQ(told({key + "=" + in("robot.yaml")}), Lines{key + ": must not be the same file as this settings file"});
    EXPECT_EQ(told({key + "=" + in("token"), "dashboard.token_file=" + in("token")}),
              Lines{key + ": must not be the same file as 'dashboard.token_file'"});
  }
}

TEST_F(RunContradictions, TheNewestMapIsNotTheFirst) {
  EXPECT_EQ(told({"map.newest=" + in("m0.yaml")}), Lines{"map.newest: must not be the same file as 'map.file'"});
  EXPECT_EQ(told({"map.newest=" + in("hall.yaml")}),
            Lines{"map.newest: its image must not be the same file as the image of 'map.file'"});
  EXPECT_EQ(told({"map.newest=" + in("map.yaml")}), Lines{});
}

TEST_F(RunContradictions, TwoOutputsAreTwoFiles) {
  const auto both = [&](const std::string& one, const std::string& other, const std::string& name = "x") {
    return told({one + "=" + in(name), other + "=" + in(name)});
  };
  EXPECT_EQ(both("map.store", "recording.file"), Lines{"recording.file: must not be the same file as 'map.store'"});
  EXPECT_EQ(both("map.store", "map.newest", "x.yaml"), Lines{"map.newest: must not be the same file as 'map.store'"});
  EXPECT_EQ(both("control.socket", "poses.socket"),
            Lines{"poses.socket: must not be the same file as 'control.socket'"});
  EXPECT_EQ(told({"map.newest=" + in("x.yaml"), "recording.file=" + in("x.pgm")}),
            Lines{"recording.file: must not be the same file as the image of 'map.newest'"});
}

TEST_F(RunContradictions, WhatAStoreKeepsBesideItIsNoOtherFile) {
  const std::string store = "map.store=" + in("s.sqlite");
  write_grid(OccupancyGrid{{3, 2, 0.05, {0.0, 0.0}}, CellState::kFree}, in("s.saved.yaml"));
  EXPECT_EQ(told({store, "map.file=" + in("s.saved.yaml")}),
            Lines{"map.store: its saved map must not be the same file as 'map.file'"})
      << "`ctl save` would write over the first map";
  EXPECT_EQ(told({store, "recording.file=" + in("s.pose.json")}),
            Lines{"recording.file: must not be the same file as the kept pose of 'map.store'"});
  EXPECT_EQ(told({store, "recording.file=" + in("s.sqlite-wal")}),
            Lines{"recording.file: must not be the same file as the log of 'map.store'"});
}

TEST_F(RunContradictions, TheRecordingOfTheRunBeforeIsNoOtherFile) {
  EXPECT_EQ(told({"map.store=" + in("run.previous.pcapng"), "recording.file=" + in("run.pcapng")}),
            Lines{"recording.file: its recording of the run before must not be the same file as 'map.store'"});
}

TEST_F(RunContradictions, LinksAndDetoursLeadToTheSameFile) {
  fs::create_symlink(in("m0.yaml"), in("link"));
  fs::create_hard_link(in("m0.yaml"), in("second_name"));
  fs::create_symlink(in("not_there_yet"), in("link_to_nothing"));
  for (const char* name : {"link", "second_name", "none/../m0.yaml"}) {
    EXPECT_EQ(told({"map.store=" + in(name)}), Lines{"map.store: must not be the same file as 'map.file'"}) << name;
  }
  EXPECT_EQ(told({"map.store=" + in("link_to_nothing"), "recording.file=" + in("not_there_yet")}),
            Lines{"recording.file: must not be the same file as 'map.store'"});
}

TEST_F(RunContradictions, EachDeviceHasAPortOfItsOwn) {
  EXPECT_EQ(told({"robot.port="}), Lines{"robot.port: must name a serial device"});
  EXPECT_EQ(told({"laser.port="}), Lines{"laser.port: must name a serial device"});
  EXPECT_EQ(told({"robot.port=/dev/null", "laser.port=/dev/null"}),
            Lines{"laser.port: must not be the same device as 'robot.port'"});
  EXPECT_EQ(told({"robot.port=/nowhere/port", "laser.port=/nowhere/port"}),
            Lines{"laser.port: must not be the same device as 'robot.port'"})
      << "a device that is not there yet";
}

TEST_F(RunContradictions, NoPathBeginsWithTheHomeOfAShell) {
  for (const char* key : {"map.file", "map.store", "map.newest", "recording.file", "control.socket", "poses.socket",
                          "dashboard.token_file", "robot.port", "laser.port"}) {
    EXPECT_EQ(told({std::string(key) + "=~/deltamap/file.yaml"}),
              Lines{std::string(key) + ": '~' is not expanded: write the whole path"});
  }
}

TEST_F(RunContradictions, AreToldWhereTheKeyIsGiven) {
  (void)folder_.write("robot.yaml", "map:\n  file: m0.yaml\n  store: " + in("robot.yaml") + "\n");
  EXPECT_EQ(look_at_settings(settings_, {}).problems,
            Lines{settings_.string() + ":3:10: map.store: must not be the same file as this settings file"});
  EXPECT_THROW((void)read_settings_of_a_run(settings_, {}), SettingsError);
  EXPECT_NO_THROW((void)read_settings(settings_, {})) << "a replay has no outputs of the settings";
}

TEST_F(RunContradictions, WhoWandersLooksWhereHeDrives) {
  const Lines refused{
      "laser.mount.yaw_deg: with 'navigation.mode' wander the laser must look where the robot drives, as wide as its "
      "hull "
      "and margin: see 'laser.mount', 'laser.variant' and 'navigation.safety'"};
  for (const std::string yaw_deg : {"180", "90", "-90", "135", "60"}) {
    EXPECT_EQ(told({"navigation.mode=wander", "laser.mount.yaw_deg=" + yaw_deg}), refused) << yaw_deg;
    EXPECT_EQ(told({"laser.mount.yaw_deg=" + yaw_deg}), Lines{}) << "it never drives";
  }
  EXPECT_EQ(told({"navigation.mode=wander", "laser.mount.x_m=0.5"}), refused)
      << "before the hull it sees nothing aside";
  EXPECT_EQ(told({"navigation.mode=wander"}), Lines{});
  EXPECT_EQ(told({"navigation.mode=wander", "laser.variant=100/1"}), Lines{});
}

TEST_F(RunContradictions, WhoWandersLooksAsWideAsHisHullAndItsMargin) {
  const auto ahead_by = [&](const std::string& x_m, const std::string& margin_m) {
    return told({"navigation.mode=wander", "laser.mount.x_m=" + x_m, "navigation.safety.robot_radius_m=0.3",
                 "navigation.safety.margin_m=" + margin_m});
  };
  EXPECT_EQ(ahead_by("0.35", "0.1"), Lines{}) << "before the hull, but not before its margin";
  EXPECT_EQ(ahead_by("0.35", "0").size(), 1u);
  EXPECT_EQ(ahead_by("0.25", "0"), Lines{});
}

}  // namespace
}  // namespace deltamap::daemon
