// SPDX-License-Identifier: Apache-2.0
#include "daemon/settings/settings.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "daemon/settings/settings_documents.hpp"
#include "tests/support/files/source_tree.hpp"
#include "tests/support/files/temporary_folder.hpp"

namespace deltamap::daemon {
namespace {

std::string error_of(const std::string& yaml, const std::vector<std::string>& overrides = {}) {
  try {
    (void)parse_settings(yaml, "robot.yaml", overrides);
  } catch (const SettingsError& error) {
    return error.what();
  }
  return "no error";
}

TEST(Settings, TheDeliveredFilesAreReadable) {
  for (const char* name : {"default", "pioneer", "simulation"}) {
    const std::string file = test::source_path("config/") + name + ".yaml";
    EXPECT_NO_THROW((void)read_settings(file, {})) << file;
  }
  const Settings pioneer = read_settings(test::source_path("config/pioneer.yaml"), {});
  EXPECT_EQ(pioneer.navigation.mode, navigation::DriveMode::kOff) << "a daemon that starts does not move the robot";
}

TEST(Settings, WhatIsPrintedReadsBackToTheSame) {
  Settings settings;
  settings.seed = 77;
  settings.robot.port = "with \"quotes\" and \\ and : colon";
  settings.laser.session.robot_from_laser = {0.25, -0.1, radians(30.0)};
  settings.initial_pose = Pose2{1.5, -2.25, radians(-156.2)};
  const std::string printed = settings_as_yaml(settings);
  const Settings again = parse_settings(printed, "printed");
  EXPECT_EQ(settings_as_yaml(again), printed);
  EXPECT_EQ(again.robot.port, settings.robot.port);
  EXPECT_NEAR(again.initial_pose->theta, radians(-156.2), 1e-12);
}

TEST(Settings, KnowWhetherHullAndUnitWereSetByHand) {
  const auto by_hand = [](const std::string& yaml, const std::vector<std::string>& overrides = {}) {
    return parse_settings(yaml, "f", overrides).robot.session.by_hand;
  };
  EXPECT_FALSE(by_hand("").hull_m) << "as delivered is not by hand";
  EXPECT_FALSE(by_hand("").metres_per_unit);
  EXPECT_FALSE(by_hand("navigation: {safety: {margin_m: 0.3}}").hull_m);
  EXPECT_EQ(by_hand("navigation: {safety: {robot_radius_m: 0.5}}").hull_m, 0.5);
  EXPECT_EQ(by_hand("navigation: {safety: {robot_radius_m: 0.26}}").hull_m, 0.26) << "though that is as delivered";
  EXPECT_EQ(by_hand("", {"navigation.safety.robot_radius_m=0.55"}).hull_m, 0.55);
  EXPECT_NEAR(*by_hand("robot: {distance_unit_mm: 0.465}").metres_per_unit, 0.000465, 1e-12);
  EXPECT_FALSE(by_hand("robot: {distance_unit_mm: 0.465}", {"robot.distance_unit_mm=0"}).metres_per_unit);
}

TEST(Settings, EveryKeyHasAMeaningAndADefaultInsideItsOwnLimits) {
  Settings settings;
  for (const SettingKey& key : keys_of(settings)) {
    EXPECT_FALSE(key.meaning.empty()) << key.name;
    EXPECT_EQ(error_of("", {key.name + "=" + key.text()}), "no error") << key.name;
  }
}

TEST(Settings, DegreesInTheFileAreRadiansBehindIt) {
  const Settings settings =
      parse_settings("laser: {mount: {yaw_deg: 90}}\nlocalization: {initial_pose: [1, 2, -90]}", "f");
  EXPECT_DOUBLE_EQ(settings.laser.session.robot_from_laser.theta, radians(90.0));
  EXPECT_DOUBLE_EQ(settings.initial_pose->theta, radians(-90.0));
}

TEST(Settings, AHeadingIsWrappedHoweverOftenItGoesRound) {
  for (const double turned_deg : {-350.0, -190.0, -180.0, 0.0, 180.0, 190.0, 270.0, 360.0, 725.0}) {
    const std::string pose = "localization.initial_pose=[1, 2, " + std::to_string(turned_deg) + "]";
    const double theta = parse_settings("", "f", {pose}).initial_pose->theta;
    EXPECT_GT(theta, -std::numbers::pi - 1e-12) << turned_deg;
    EXPECT_LE(theta, std::numbers::pi + 1e-12) << turned_deg;
    EXPECT_NEAR(std::remainder(theta - radians(turned_deg), 2.0 * std::numbers::pi), 0.0, 1e-9) << turned_deg;
  }
}

TEST(Settings, OneKeySaysHowFarABeamSaysAndDrawsSomething) {
  const Settings settings = parse_settings("", "f", {"mapping.evidence.most_range_m=30"});
  EXPECT_EQ(settings.mapping.store_scan.evidence.beams.most_range_m, 30.0);
  EXPECT_EQ(settings.mapping.update.evidence.longest_m, 30.0);
  EXPECT_EQ(Settings{}.mapping.store_scan.evidence.beams.most_range_m, Settings{}.mapping.update.evidence.longest_m);
}

TEST(Settings, OneKeySaysHowWideTheRobotIsForSafetyAndForWandering) {
  const Settings settings = parse_settings("navigation: {safety: {robot_radius_m: 0.4, hidden_width_m: 0.2}}", "f");
  EXPECT_EQ(settings.navigation.safety.robot_radius_m, 0.4);
  EXPECT_EQ(settings.navigation.wander.robot_radius_m, 0.4);
  EXPECT_EQ(settings.navigation.safety.obstacles.hidden_width_m, 0.2);
  EXPECT_EQ(settings.navigation.wander.obstacles.hidden_width_m, 0.2);
  const NavigationSettings delivered;
  EXPECT_EQ(delivered.safety.robot_radius_m, delivered.wander.robot_radius_m);
  EXPECT_EQ(delivered.safety.obstacles.hidden_width_m, delivered.wander.obstacles.hidden_width_m);
}

TEST(Settings, AnUnknownKeyIsNamedWithFileLineAndTheNearestKnownOne) {
  EXPECT_EQ(error_of("seed: 1\nlaser:\n  prot: /dev/ttyS0\n"),
            "robot.yaml:3:3: laser.prot: unknown key (nearest key laser.port)");
  EXPECT_EQ(error_of("laser: {mount: {x: 1}}"),
            "robot.yaml:1:17: laser.mount.x: unknown key (nearest key laser.mount.x_m)");
}

TEST(Settings, AnIllTypedValueIsNamedWithWhatTheKeyNeeds) {
  EXPECT_EQ(error_of("laser:\n  max_range_m: far"),
            "robot.yaml:2:16: laser.max_range_m: needs a number (m, 0 to 90), not 'far'");
  EXPECT_EQ(error_of("seed: 1.5"), "robot.yaml:1:7: seed: needs a whole number (from 0), not '1.5'");
  EXPECT_EQ(error_of("seed: \"1\""), "robot.yaml:1:7: seed: needs a whole number (from 0), not '1' in quotes");
  EXPECT_EQ(error_of("robot: {sonar: \"true\"}"),
            "robot.yaml:1:16: robot.sonar: needs true or false, not 'true' in quotes");
  EXPECT_EQ(error_of("seed: 12345678901234567890123"),
            "robot.yaml:1:7: seed: needs a whole number in its range (0 to 9223372036854775807), not "
            "'12345678901234567890123'");
  EXPECT_EQ(error_of("robot: {sonar: yes}"), "robot.yaml:1:16: robot.sonar: needs true or false, not 'yes'");
  EXPECT_EQ(error_of("laser: {units: inch}"), "robot.yaml:1:16: laser.units: needs one of cm | mm, not 'inch'");
  EXPECT_EQ(error_of("localization: {initial_pose: [1, 2]}"),
            "robot.yaml:1:30: localization.initial_pose: needs [x m, y m, heading degrees] or null, not a list of 2");
  EXPECT_EQ(
      error_of("localization: {initial_pose: [1, 2, north]}"),
      "robot.yaml:1:30: localization.initial_pose: needs [x m, y m, heading degrees] or null, not '[1, 2, north]'");
  EXPECT_EQ(error_of("laser: {port: [a]}"), "robot.yaml:1:15: laser.port: needs text (\"\" for none), not a list");
  EXPECT_EQ(error_of("laser: {max_range_m: .nan}"),
            "robot.yaml:1:22: laser.max_range_m: needs a number (m, 0 to 90), not '.nan'");
  EXPECT_EQ(error_of("seed: {a: 1}"), "robot.yaml:1:7: seed: takes one value, not keys");
}

TEST(Settings, EveryKeyThatScriptsSetIsKnown) {
  const Settings settings = parse_settings("", "robot.yaml",
                                           {"robot.port=/dev/a b",
                                            "robot.model=p3dx",
                                            "laser.port=",
                                            "laser.baud=500000",
                                            "laser.variant=100/0.25",
                                            "laser.units=cm",
                                            "laser.max_range_m=32",
                                            "laser.mount.x_m=0.25",
                                            "laser.mount.y_m=-0.1",
                                            "laser.mount.yaw_deg=-90",
                                            "localization.beams=0",
                                            "localization.particles.min=500",
                                            "localization.particles.max=500",
                                            "mapping.enabled=false",
                                            "mapping.method=paper",
                                            "mapping.persistence_s=3",
                                            "navigation.mode=wander",
                                            "map.file=m.yaml",
                                            "map.store=s.sqlite",
                                            "control.socket=/run/deltamap/ctl.sock",
                                            "recording.file=r.pcapng",
                                            "recording.max_gigabytes=1"});
  EXPECT_EQ(settings.robot.port, "/dev/a b");
  EXPECT_EQ(settings.laser.port, "");
  EXPECT_EQ(settings.control.socket, "/run/deltamap/ctl.sock");
}

TEST(Settings, PatrolIsRefusedUntilItIsBuilt) {
  const std::string why = "navigation.mode: needs off or wander (patrol does not exist yet), not 'patrol'";
  EXPECT_EQ(error_of("seed: 1\nnavigation:\n  mode: patrol\n"), "robot.yaml:3:9: " + why);
  EXPECT_EQ(error_of("", {"navigation.mode=patrol"}), "--set navigation.mode=patrol: " + why);
}

TEST(Settings, ValuesThatContradictEachOtherAreRefused) {
  EXPECT_EQ(error_of("localization: {particles: {min: 900, max: 800}}"),
            "robot.yaml:1:33: localization.particles.min: must not exceed 'localization.particles.max'");
}

TEST(Settings, TheLivePageLeavesThisMachineOnlyWithAToken) {
  EXPECT_EQ(error_of("dashboard: {address: 0.0.0.0, port: 8484}"),
            "robot.yaml:1:22: dashboard.address: leads beyond this machine: that needs 'dashboard.token_file'");
  EXPECT_EQ(error_of("dashboard: {address: 0.0.0.0, port: 8484, token_file: t}"), "no error");
  EXPECT_EQ(error_of("dashboard: {address: \"::1\", port: 8484}"), "no error");
  EXPECT_EQ(error_of("dashboard: {address: robot.example}"),
            "robot.yaml:1:22: dashboard.address: needs an IPv4 or IPv6 address, not 'robot.example'");
  EXPECT_EQ(error_of("dashboard: {port: 8484, control: true}"),
            "robot.yaml:1:34: dashboard.control: needs 'control.socket': one desk takes all commands");
  EXPECT_EQ(error_of("dashboard: {port: 8484, control: true}\ncontrol: {socket: s}"), "no error");
  EXPECT_EQ(error_of("dashboard: {control: true}"), "no error") << "there is no page";
  EXPECT_EQ(error_of("dashboard: {port: 65536}"),
            "robot.yaml:1:19: dashboard.port: needs a whole number in its range (0 to 65535), not '65536'");
}

TEST(Settings, BrokenYamlIsNamedWithItsLine) {
  EXPECT_TRUE(error_of("seed: 1\nlaser: [1, 2\nrobot: {").starts_with("robot.yaml:"))
      << error_of("seed: 1\nlaser: [1, 2\nrobot: {");
  EXPECT_EQ(error_of("seed: 1\nlaser: [1, 2\nrobot: {").find('\n'), std::string::npos);
  EXPECT_EQ(error_of("just words"), "robot.yaml:1:1: the file must hold keys, not 'just words'");
}

TEST(Settings, AMissingFileIsNamedWithTheReason) {
  const auto error_with = [](const std::filesystem::path& file) {
    try {
      (void)read_settings(file, {});
    } catch (const SettingsError& error) {
      return std::string(error.what());
    }
    return std::string("no error");
  };
  EXPECT_EQ(error_with("/nowhere/x.yaml"), "/nowhere/x.yaml: cannot read the settings: No such file or directory");
  EXPECT_EQ(error_with("/tmp"), "/tmp: cannot read the settings: is a folder");
}

TEST(Settings, AnOverrideFollowsTheSameRulesAndComesLast) {
  const Settings settings = parse_settings("seed: 1", "f", {"seed=5", "laser.mount.x_m=0.25", "robot.port="});
  EXPECT_EQ(settings.seed, 5u);
  EXPECT_DOUBLE_EQ(settings.laser.session.robot_from_laser.x, 0.25);
  EXPECT_EQ(settings.robot.port, "");
  EXPECT_EQ(error_of("", {"sede=5"}), "--set sede=5: sede: unknown key (nearest key seed)");
  EXPECT_EQ(error_of("", {"seed=many"}), "--set seed=many: seed: needs a whole number (from 0), not 'many'");
  EXPECT_EQ(error_of("", {"seed"}), "--set seed: give key=value");
}

TEST(Settings, TheFingerprintFollowsWhatDecidesResultsAndNothingElse) {
  const std::uint64_t before = settings_fingerprint(Settings{});
  EXPECT_EQ(settings_fingerprint(parse_settings("{robot: {port: /a}, recording: {file: b}}", "f")), before);
  EXPECT_NE(settings_fingerprint(parse_settings("seed: 2", "f")), before);
  EXPECT_NE(settings_fingerprint(parse_settings("localization: {initial_pose: [0, 0, 0]}", "f")), before);
}

TEST(Settings, TakeIgnoredBearingsInPairs) {
  const auto ignored = [](const std::string& text) {
    return parse_settings("laser:\n  ignored_deg: " + text + "\n", "f", {}).laser.session.ignored;
  };
  const auto two = ignored("[[-32, -28], [88, 90]]");
  ASSERT_EQ(two.size(), 2u);
  EXPECT_NEAR(two[0].from_rad, radians(-32.0), 1e-12);
  EXPECT_NEAR(two[1].to_rad, radians(90.0), 1e-12);
  EXPECT_TRUE(ignored("[]").empty());
  for (const char* bad : {"[[10, -10]]", "[10, 20]", "[[10, 20, 30]]", "[[170, 190]]"})
    EXPECT_THROW((void)ignored(bad), SettingsError) << bad;
}

}  // namespace
}  // namespace deltamap::daemon
