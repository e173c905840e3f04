// SPDX-License-Identifier: Apache-2.0
// `deltamap score` of a simulation in which nothing has changed.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/support/files/temporary_folder.hpp"
#include "tests/support/files/tool_run.hpp"

namespace deltamap::tool {
namespace {

TEST(Score, SaysWhereThereIsNothingToScore) {
  const test::TemporaryFolder folder;
  const auto file = [&](const std::string& name) { return (folder.path() / name).string(); };
  const std::string world =
      folder.write("world.yaml", "walls:\n  - [[0, 0], [4, 0], [4, 3], [0, 3], [0, 0]]\nrobot:\n  start: [1, 1, 0]\n")
          .string();
  ASSERT_EQ(test::run_deltamap({"sim", "--world", world, "--write-map", file("map.yaml")}).exit_code, 0);
  const std::string truth =
      folder.write("truth.jsonl", "{\"t_ns\":10000000000,\"pose\":[1,1,0]}\n{\"t_ns\":30000000000,\"pose\":[1,1,0]}\n")
          .string();
  const std::string trajectory = folder.write("run.tum", "11 1 1 0 0 0 0 1\n29 1 1 0 0 0 0 1\n").string();
  const std::vector<std::string> words{"score",         "--truth",  truth,   "--world",        world,
                                       "--trajectory",  trajectory, "--map", file("map.yaml"), "--start-map",
                                       file("map.yaml")};
  const test::ToolRun told = test::run_deltamap(words);
  ASSERT_EQ(told.exit_code, 0) << told.errors;
  EXPECT_NE(told.output.find("nothing to score, since no change was seen for 10 s"), std::string::npos) << told.output;
  EXPECT_EQ(told.output.find("(100"), std::string::npos) << told.output;
  std::vector<std::string> as_json = words;
  as_json.push_back("--json");
  const auto json = nlohmann::json::parse(test::run_deltamap(as_json).output);
  EXPECT_TRUE(json["changes"]["recall"].is_null());
  EXPECT_EQ(json["changes"]["eligible"], 0);
}

TEST(Score, TakesADeliveredScenarioByItsName) {
  const test::ToolRun told = test::run_deltamap(
      {"score", "--truth", "/no/such", "--world", "hill", "--trajectory", "t", "--map", "m", "--start-map", "m"});
  EXPECT_EQ(told.exit_code, 1);
  EXPECT_NE(told.errors.find("hill: no such file, and no scenario: "), std::string::npos) << told.errors;
  const test::ToolRun known = test::run_deltamap(
      {"score", "--truth", "/no/such", "--world", "hall", "--trajectory", "t", "--map", "m", "--start-map", "m"});
  EXPECT_EQ(known.errors.find("hall"), std::string::npos) << known.errors;
}

TEST(Sim, RefusesBesideWriteMapWhatOnlyADriveObeys) {
  const test::TemporaryFolder folder;
  const std::string map = (folder.path() / "m.yaml").string();
  const std::vector<std::vector<std::string>> of_a_drive{
      {"--for", "5"},          {"--truth", "t.jsonl"},     {"--links", "."},       {"--seed", "2"},
      {"--change-every", "3"}, {"--fault", "laser_blind"}, {"--fault-after", "1"}, {"--fault-for", "1"}};
  for (const std::vector<std::string>& option : of_a_drive) {
    std::vector<std::string> words{"sim", "--world", "hall", "--write-map", map};
    words.insert(words.end(), option.begin(), option.end());
    const test::ToolRun told = test::run_deltamap(words);
    EXPECT_EQ(told.exit_code, 2) << option[0];
    EXPECT_NE(told.errors.find(option[0]), std::string::npos) << told.errors;
    EXPECT_FALSE(std::filesystem::exists(map)) << option[0];
  }
  EXPECT_EQ(test::run_deltamap({"sim", "--world", "hall", "--resolution", "0.1", "--for", "1"}).exit_code, 2);
}

}  // namespace
}  // namespace deltamap::tool
