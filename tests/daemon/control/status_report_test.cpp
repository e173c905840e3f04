// SPDX-License-Identifier: Apache-2.0
#include "daemon/control/status_report.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace deltamap::daemon::control {
namespace {

TEST(StatusReport, TellsNoWeightOfAScanOfWhichNoBeamTells) {
  Telemetry telemetry;
  const auto told = [&] { return nlohmann::json::parse(status_json_line(telemetry, {}, 1.0)); };
  const auto is_null = [&](const char* field) { return told().contains(field) && told()[field].is_null(); };
  EXPECT_TRUE(is_null("w_avg")) << "no scan yet";
  EXPECT_TRUE(is_null("fit"));
  telemetry.localized.set(1);
  telemetry.estimate.w_avg.set(0.75);
  telemetry.fit.set(0.5);
  EXPECT_EQ(told()["w_avg"], 0.75);
  EXPECT_EQ(told()["fit"], 0.5);
  telemetry.fit.set(-1.0);
  EXPECT_TRUE(is_null("w_avg")) << "that would be an older scan's";
  EXPECT_TRUE(is_null("fit"));
}

TEST(StatusReport, TellsNothingBeforeTheFirstScanThatOnlyAScanTells) {
  Telemetry telemetry;
  const auto told = [&] { return nlohmann::json::parse(status_json_line(telemetry, {}, 1.0)); };
  for (const char* field : {"pose", "covariance", "belief", "particles", "n_eff", "revision", "latency_ms"}) {
    EXPECT_TRUE(told().contains(field) && told()[field].is_null()) << field;
  }
  const std::string line = told()["line"];
  EXPECT_NE(line.find("no scan yet"), std::string::npos) << line;
  EXPECT_EQ(line.find("x="), std::string::npos) << line;
  telemetry.localized.set(1);
  for (const char* field : {"pose", "covariance", "belief", "particles", "n_eff", "revision", "latency_ms"}) {
    EXPECT_FALSE(told()[field].is_null()) << field;
  }
}

TEST(StatusReport, CallsNoGateOpenWhereNoScanVotes) {
  Telemetry telemetry;
  Settings settings;
  const auto gate = [&] { return nlohmann::json::parse(status_json_line(telemetry, settings, 1.0))["gate"]; };
  const auto expect_closed = [&](const char* why) {
    EXPECT_EQ(gate()["open"], false) << why;
    EXPECT_EQ(gate()["reason"], why);
  };
  expect_closed("no scans");
  telemetry.localized.set(1);
  telemetry.laser_up.set(true);
  expect_closed("searching");
  telemetry.gate.set(mapping::gate::GateReason::kOpen, {});
  EXPECT_EQ(gate()["open"], true);
  telemetry.laser_up.set(false);
  expect_closed("no scans");
  telemetry.laser_up.set(true);
  telemetry.paused.set(true);
  expect_closed("paused");
  settings.mapping.enabled = false;
  expect_closed("off");
}

TEST(StatusReport, TellsWhyAPortIsDownAndNoBatteryOfARobotThatIsSilent) {
  Telemetry telemetry;
  const auto told = [&] { return nlohmann::json::parse(status_json_line(telemetry, {}, 1.0)); };
  telemetry.robot_trouble.set("/dev/ttyUSB0: busy");
  telemetry.battery_v.set(12.5);
  EXPECT_EQ(told()["port_troubles"]["robot"], "/dev/ttyUSB0: busy");
  EXPECT_TRUE(told()["battery_v"].is_null());
  telemetry.robot_up.set(true);
  EXPECT_FALSE(told()["port_troubles"].contains("robot"));
  EXPECT_EQ(told()["battery_v"], 12.5);
  telemetry.battery_v.set(0.0);
  EXPECT_TRUE(told()["battery_v"].is_null()) << "the robot has not told it";
}

}  // namespace
}  // namespace deltamap::daemon::control
