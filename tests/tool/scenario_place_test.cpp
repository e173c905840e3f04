// SPDX-License-Identifier: Apache-2.0
#include "tool/scenario_place.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

#include "tests/support/files/temporary_folder.hpp"

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

TEST_F(ScenarioPlace, OutsideTheRepositoryItIsTheInstalledFolder) {
  fs::create_directory("elsewhere");
  fs::current_path("elsewhere");
  EXPECT_TRUE(scenario_folder().is_absolute());
  EXPECT_TRUE(scenario_folder().string().ends_with("/share/deltamap/scenarios"));
}

}  // namespace
}  // namespace deltamap::tool
