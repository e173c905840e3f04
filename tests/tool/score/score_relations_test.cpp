// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "tests/support/files/temporary_folder.hpp"
#include "tool/run_tool.hpp"

namespace deltamap::tool {
namespace {

/// Straight on, a metre a second.
constexpr const char* kTrajectory =
    "10.000000 0 0 0 0 0 0 1\n11.000000 1 0 0 0 0 0 1\n12.000000 2 0 0 0 0 0 1\n13.000000 3 0 0 0 0 0 1\n";

class ScoreRelations : public testing::Test {
 protected:
  /// Answers the exit code; keeps what was printed.
  int score(const std::string& relations, bool json) {
    const std::string tum = folder_.write("drive.tum", kTrajectory);
    const std::string file = folder_.write("some.relations", relations);
    const char* arguments[] = {"deltamap", "score", "relations", tum.c_str(), file.c_str(), "--json"};
    testing::internal::CaptureStdout();
    testing::internal::CaptureStderr();
    const int code = run_tool(json ? 6 : 5, arguments);
    out_ = testing::internal::GetCapturedStdout();
    error_ = testing::internal::GetCapturedStderr();
    return code;
  }

  test::TemporaryFolder folder_;
  std::string out_;
  std::string error_;
};

TEST_F(ScoreRelations, PrintsWhatTheTrajectoryIsOff) {
  ASSERT_EQ(score("10 12 2.1 0 0 0 0 0\n10 13 3 0.3 0 0 0 0\n9 13 3 0 0 0 0 0\n", true), 0) << error_;
  const auto told = nlohmann::json::parse(out_);
  EXPECT_EQ(told["relations"], 2);
  EXPECT_EQ(told["outside"], 1);
  EXPECT_NEAR(told["translation_m"]["mean"].get<double>(), 0.2, 1e-6);
  EXPECT_NEAR(told["translation_m"]["deviation"].get<double>(), 0.1, 1e-6);
  EXPECT_NEAR(told["rotation_deg"]["mean"].get<double>(), 0.0, 1e-6);
  ASSERT_EQ(score("10 12 2 0 0 0 0 0.1\n", false), 0) << error_;
  EXPECT_NE(out_.find("1 relation, 0 outside"), std::string::npos) << out_;
  EXPECT_NE(out_.find("rotation:            5.7296 +- 0.0000 deg"), std::string::npos) << out_;
}

TEST_F(ScoreRelations, SaysInOneLineWhyItCannot) {
  EXPECT_EQ(score("10 12 2.1\n", false), 1);
  EXPECT_NE(error_.find("some.relations: line 1: not a relation"), std::string::npos) << error_;
  EXPECT_EQ(score("20 21 0 0 0 0 0 0\n", false), 1);
  EXPECT_NE(error_.find("no relation lies within the time of"), std::string::npos) << error_;
}

TEST_F(ScoreRelations, RefusesOptionsOfTheScoreOfASimulation) {
  const char* arguments[] = {"deltamap", "score", "--json", "relations", "drive.tum", "some.relations"};
  testing::internal::CaptureStderr();
  EXPECT_EQ(run_tool(6, arguments), 2);
  EXPECT_NE(testing::internal::GetCapturedStderr().find("relations excludes --json"), std::string::npos);
}

TEST_F(ScoreRelations, LeavesTheScoreOfASimulationAsItWas) {
  const char* arguments[] = {"deltamap", "score", "--world", "hall.yaml"};
  testing::internal::CaptureStderr();
  EXPECT_EQ(run_tool(4, arguments), 2);
  EXPECT_NE(testing::internal::GetCapturedStderr().find("--truth is required"), std::string::npos);
}

}  // namespace
}  // namespace deltamap::tool
