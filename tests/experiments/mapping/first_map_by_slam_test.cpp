// SPDX-License-Identifier: Apache-2.0
// `deltamap-lab first-map`: what a short run measures, and which seeds it refuses.
#include <gtest/gtest.h>

#include <sstream>

#include "tests/support/files/lab_run.hpp"
#include "tests/support/files/temporary_folder.hpp"
#include "tests/support/files/text_file.hpp"

namespace deltamap::experiments {
namespace {

test::ToolRun first_map(const std::string& out, const std::vector<std::string>& more) {
  std::vector<std::string> words{"first-map", "--out", out};
  words.insert(words.end(), more.begin(), more.end());
  return test::run_lab(words);
}

/// The number of the first run by the name of its column.
double number_of(const std::string& table, const std::string& name) {
  std::istringstream lines{table};
  std::string names;
  std::string values;
  std::getline(lines, names);
  std::getline(lines, values);
  std::istringstream name_words{names};
  std::istringstream value_words{values};
  std::string one;
  std::string value;
  while (std::getline(name_words, one, ',') && std::getline(value_words, value, ',')) {
    if (one == name) return std::stod(value);
  }
  ADD_FAILURE() << "no column " << name;
  return 0.0;
}

TEST(FirstMapExperiment, HoldsTheDrivesOfASeedAgainstTheTruth) {
  const test::TemporaryFolder folder;
  const test::ToolRun run = first_map(folder.path().string(), {"--seed", "588", "--repeats", "1", "--minutes", "3"});
  ASSERT_EQ(run.exit_code, 0) << run.errors;
  const std::string table = test::content_of(folder.path() / "first-map.csv");
  EXPECT_GT(number_of(table, "keyframes"), 50.0);
  EXPECT_LT(number_of(table, "error_rms_m"), 0.2);
  EXPECT_GT(number_of(table, "error_rms_m"), 0.0);
  EXPECT_GT(number_of(table, "contour_f1"), 0.5);
  EXPECT_GT(number_of(table, "matched_share"), 0.8);
}

TEST(FirstMapExperiment, RefusesToMixSeedsOfDevelopmentAndFinalFigures) {
  const test::TemporaryFolder folder;
  EXPECT_EQ(first_map((folder.path() / "out").string(), {"--seed", "999", "--repeats", "2"}).exit_code, 2);
}

}  // namespace
}  // namespace deltamap::experiments
