// SPDX-License-Identifier: Apache-2.0
#include "tool/scenario_place.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

#include "tests/support/files/temporary_folder.hpp"
#include "tests/support/files/tool_run.hpp"

namespace deltamap::tool {
namespace {

namespace fs = std::filesystem;

/// In a folder that has config/scenarios as the repository does.
class ScenarioPlace : public testing::Test {
 protected:
  void SetUp() override {
    fs::create_directories(folder_.path() / "config/scenarios");
    (void)folder_.write("config/scenarios/hall.yaml", "");
    (void)folder_.write("config/scenarios/room.yaml", "");
    fs::current_path(folder_.path());
  }
  void TearDown() override { fs::current_path(before_); }

  test::TemporaryFolder folder_;
  fs::path before_ = fs::current_path();
};

TEST_F(ScenarioPlace, ABareWordIsADeliveredScenario) { EXPECT_EQ(scenario_file("hall"), "config/scenarios/hall.yaml"); }

TEST_F(ScenarioPlace, AFileGoesBeforeADeliveredScenario) {
  (void)folder_.write("hall", "");
  EXPECT_EQ(scenario_file("hall"), "hall");
}

TEST_F(ScenarioPlace, WhatHasAFolderOrAnEndingIsAFile) {
  EXPECT_EQ(scenario_file("hall.yaml"), "hall.yaml");
  EXPECT_EQ(scenario_file("./hall"), "./hall");
}

TEST_F(ScenarioPlace, AnUnknownNameIsRefusedWithTheKnownOnes) {
  try {
    (void)scenario_file("hill");
    FAIL() << "there is no scenario hill";
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(), "hill: no such file, and no scenario: config/scenarios has hall, room");
  }
}

TEST_F(ScenarioPlace, AnInstalledProgramOutsideTheRepositoryTakesTheInstalledFolder) {
  fs::create_directory("elsewhere");
  fs::current_path("elsewhere");
  EXPECT_TRUE(scenario_folder("/usr/bin/deltamap").is_absolute());
  EXPECT_TRUE(scenario_folder("/usr/bin/deltamap").string().ends_with("/share/deltamap/scenarios"));
}

TEST_F(ScenarioPlace, AProgramOfABuildTreeFindsThoseOfItsSourcesFromAnywhere) {
  fs::create_directory("elsewhere");
  fs::current_path("elsewhere");
  EXPECT_EQ(scenario_folder(folder_.path() / "build/release/bin/deltamap"), folder_.path() / "config/scenarios");
}

TEST(CommandLine, NamesTheNearestCommandOneLevelBelow) {
  const std::pair<const char*, const char*> nearest[] = {{"veiw", "view"},
                                                         {"status", "ctl status"},
                                                         {"stauts", "ctl status"},
                                                         {"merge", "map merge"},
                                                         {"carmn", "import carmen"}};
  for (const auto& [word, command] : nearest) {
    const auto run = test::run_deltamap({word});
    EXPECT_EQ(run.exit_code, 2) << word;
    EXPECT_NE(run.errors.find("unknown command '" + std::string(word) + "' (nearest command " + command + ")"),
              std::string::npos)
        << run.errors;
  }
  EXPECT_EQ(test::run_deltamap({"qqqqqqq"}).errors.find("nearest"), std::string::npos);
}

}  // namespace
}  // namespace deltamap::tool
