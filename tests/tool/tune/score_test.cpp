// SPDX-License-Identifier: Apache-2.0
// `deltamap compare` and `score` on a short drive through a small room.
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/tool/tune/tuned_drive.hpp"

namespace deltamap::tool {
namespace {

using test::run_deltamap;
using test::ToolRun;
using test::Words;
using Json = nlohmann::json;

using ScoreTest = test::TunedDriveTest;

TEST_F(ScoreTest, APartOfARecordingIsNotLostForItsRest) {
  const auto lost_share = [&](const Words& part) {
    Words words{"--seeds", "1", "--json"};
    words.insert(words.end(), part.begin(), part.end());
    const ToolRun scored = run("score", words);
    EXPECT_EQ(scored.exit_code, 0) << scored.errors;
    return Json::parse(scored.output).at(0).at("measures").at("lost_share").at("mean").get<double>();
  };
  EXPECT_EQ(lost_share({}), 0.0);
  EXPECT_EQ(lost_share({"--from", "1", "--to", "3"}), 0.0);
}

TEST_F(ScoreTest, ComparesConfigurationsAndSaysWhereTheyDoNotDiffer) {
  const std::string a = folder_.write("a.yaml", "localization:\n  beams: 60\n").string();
  const std::string b = folder_.write("b.yaml", "localization:\n  beams: 60\n").string();
  const ToolRun same = run("compare", {"--config", a, "--config", b, "--seeds", "2"});
  ASSERT_EQ(same.exit_code, 0) << same.errors;
  EXPECT_NE(same.output.find("error_rmse_m, a.yaml against b.yaml: no difference that these recordings can show"),
            std::string::npos)
      << same.output;
  (void)folder_.write("b.yaml", "mapping:\n  enabled: false\nlocalization:\n  beams: 3\n");
  const Json json = Json::parse(run("compare", {"--config", a, "--config", b, "--seeds", "3", "--json"}).output);
  EXPECT_EQ(json["runs"].size(), 6u);
  EXPECT_EQ(run("compare", {"--config", a}).exit_code, 2) << "there is nothing to compare";
}

TEST_F(ScoreTest, ScoresRecordingsAndFoldersAlikeAndWithoutAnyTruth) {
  const ToolRun recording = run("score", {"--seeds", "2", "--json"});
  ASSERT_EQ(recording.exit_code, 0) << recording.errors;
  const Json scored = Json::parse(recording.output)[0]["measures"];
  EXPECT_LT(scored["error_rmse_m"]["mean"].get<double>(), 0.05);
  EXPECT_GT(scored["agreement"]["mean"].get<double>(), 0.8) << "the box is not written yet";
  EXPECT_GE(scored["repeatability_m"]["mean"].get<double>(), 0.0);
  EXPECT_LT(scored["repeatability_m"]["mean"].get<double>(), 0.05);
  const Pose2 start = test::pose_on_drive(0.0);
  char pose[96];
  (void)std::snprintf(pose, sizeof pose, "--initial-pose=%.3f,%.3f,%.1f", start.x, start.y, degrees(start.theta));
  ASSERT_EQ(run_deltamap(
                {"replay", file("drive.pcapng"), "--map", file("room.yaml"), pose, "--seed", "1", "--out", file("run")})
                .exit_code,
            0);
  const ToolRun folder = run_deltamap({"score", file("run"), "--reference", file("truth.txt"), "--json"});
  ASSERT_EQ(folder.exit_code, 0) << folder.errors;
  const Json of_folder = Json::parse(folder.output)[0]["measures"];
  EXPECT_NEAR(of_folder["error_rmse_m"]["mean"].get<double>(), scored["error_rmse_m"]["mean"].get<double>(), 0.01);
  EXPECT_NEAR(of_folder["agreement"]["mean"].get<double>(), scored["agreement"]["mean"].get<double>(), 0.03);
  const ToolRun blind = run_deltamap({"score", file("run")});
  ASSERT_EQ(blind.exit_code, 0) << blind.errors;
  EXPECT_EQ(blind.output.find("error_rmse_m"), std::string::npos);
  EXPECT_NE(blind.output.find("agreement"), std::string::npos) << blind.output;
  EXPECT_NE(blind.errors.find("errors are not known"), std::string::npos) << blind.errors;
  std::filesystem::remove(file("drive.pcapng"));
  const ToolRun gone = run_deltamap({"score", file("run")});
  EXPECT_EQ(gone.exit_code, 0);
  EXPECT_NE(gone.errors.find("drive.pcapng is not there: whether scans agree"), std::string::npos) << gone.errors;
}

TEST_F(ScoreTest, ScoreAsksForWhatItNeeds) {
  EXPECT_EQ(run_deltamap({"score"}).exit_code, 2);
  EXPECT_EQ(run_deltamap({"score", "--world", "w.yaml"}).exit_code, 2);
  EXPECT_EQ(run_deltamap({"score", file("room.yaml") + ".none"}).exit_code, 2) << "a recording needs --map";
}

}  // namespace
}  // namespace deltamap::tool
