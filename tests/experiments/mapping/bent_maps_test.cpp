// SPDX-License-Identifier: Apache-2.0
// `deltamap-lab bent-maps`: what is called false and good of one seed's drives.
#include <gtest/gtest.h>

#include <map>
#include <nlohmann/json.hpp>

#include "tests/support/files/lab_run.hpp"
#include "tests/support/files/temporary_folder.hpp"

namespace deltamap::experiments {
namespace {

TEST(BentMapsExperiment, TellsBentMapsFromGoodOnes) {
  const test::TemporaryFolder folder;
  const test::ToolRun run = test::run_lab({"bent-maps", "--out", folder.path().string(), "--seed", "605", "--repeats",
                                           "1", "--minutes", "6", "--jobs", "1", "--json"});
  ASSERT_EQ(run.exit_code, 0) << run.errors;
  std::map<std::string, double> figures;
  const auto summary = nlohmann::json::parse(run.output);
  for (const auto& figure : summary["figures"])
    figures[figure["name"].get<std::string>()] = figure["value"].get<double>();
  EXPECT_GE(figures.at("bent maps"), 3.0);
  EXPECT_GE(figures.at("of them called false"), 0.75);
  EXPECT_GE(figures.at("good maps"), 1.0);
  EXPECT_EQ(figures.at("of them called good"), 1.0);
}

}  // namespace
}  // namespace deltamap::experiments
