// SPDX-License-Identifier: Apache-2.0
#include "daemon/live/pose_line.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>
#include <set>

namespace deltamap::daemon {
namespace {

using nlohmann::json;

PoseNews news() {
  PoseNews news;
  news.row.time = timestamp_from_ns(1'764'000'000'250'000'000);
  news.row.number = 7;
  news.row.map_from_robot = {1.5, -2.0, 0.25};
  news.row.covariance << 1, 2, 3, 2, 4, 5, 3, 5, 6;
  news.row.state = LocalizerState::kTracking;
  news.row.belief.verdict = PoseVerdict::kRight;
  news.row.revision = 3;
  news.latency_s = 0.002;
  news.gate = mapping::gate::GateReason::kOpen;
  return news;
}

TEST(PoseLine, TellsPoseCovarianceVerdictTimeAndGate) {
  const std::string line = pose_line(news());
  EXPECT_EQ(line.find('\n'), std::string::npos);
  const json told = json::parse(line);
  EXPECT_EQ(told["type"], "pose");
  EXPECT_DOUBLE_EQ(told["time"], 1'764'000'000.25);
  EXPECT_EQ(told["scan"], 7);
  EXPECT_EQ(told["x_m"], 1.5);
  EXPECT_EQ(told["y_m"], -2.0);
  EXPECT_EQ(told["heading_rad"], 0.25);
  EXPECT_EQ(told["covariance"],
            (json{{"xx_m2", 1}, {"xy_m2", 2}, {"yy_m2", 4}, {"xh_m_rad", 3}, {"yh_m_rad", 5}, {"hh_rad2", 6}}));
  EXPECT_EQ(told["state"], "tracking");
  EXPECT_EQ(told["verdict"], "right");
  EXPECT_EQ(told["revision"], 3);
  EXPECT_EQ(told["other_hypothesis"], nullptr);
  EXPECT_EQ(told["gate"], (json{{"open", true}, {"reason", nullptr}}));
  EXPECT_DOUBLE_EQ(told["latency_ms"], 2.0);
}

TEST(PoseLine, AShutGateTellsWhyAndNoMappingNoGate) {
  PoseNews shut = news();
  shut.gate = mapping::gate::GateReason::kLost;
  const json gate = json::parse(pose_line(shut))["gate"];
  EXPECT_EQ(gate["open"], false);
  EXPECT_EQ(gate["reason"], name_of(mapping::gate::GateReason::kLost));
  shut.gate.reset();
  EXPECT_EQ(json::parse(pose_line(shut))["gate"], nullptr);
}

TEST(PoseLine, TheOtherHypothesisIsToldWithItsShare) {
  PoseNews doubtful = news();
  doubtful.row.belief.other_share = 0.25;
  doubtful.row.belief.map_from_other = {4.0, 5.0, 1.0};
  EXPECT_EQ(json::parse(pose_line(doubtful))["other_hypothesis"],
            (json{{"x_m", 4.0}, {"y_m", 5.0}, {"heading_rad", 1.0}, {"share", 0.25}}));
}

TEST(PoseLine, PlannersAreToldWhetherTheyMayDriveAndWhatForbidsIt) {
  PoseNews told = news();
  EXPECT_FALSE(json::parse(pose_line(told)).contains("may_drive_by_pose"));
  told.forbidden_by = navigation::StopReason::kNone;
  EXPECT_EQ(json::parse(pose_line(told))["may_drive_by_pose"], true);
  EXPECT_EQ(json::parse(pose_line(told))["forbidden_by"], "none");
  told.forbidden_by = navigation::StopReason::kLaserBlind;
  EXPECT_EQ(json::parse(pose_line(told))["may_drive_by_pose"], false);
  EXPECT_EQ(json::parse(pose_line(told))["forbidden_by"], "laser sees nothing");
}

TEST(PoseLine, ANumberThatIsNoneIsNull) {
  PoseNews broken = news();
  broken.row.covariance(0, 0) = std::numeric_limits<double>::infinity();
  EXPECT_EQ(json::parse(pose_line(broken))["covariance"]["xx_m2"], nullptr);
}

}  // namespace
}  // namespace deltamap::daemon
