// SPDX-License-Identifier: Apache-2.0
// `deltamap-lab bent-maps`: what is called false and good of one seed's drives.
#include <gtest/gtest.h>

#include "tests/support/files/lab_run.hpp"
#include "tests/support/files/temporary_folder.hpp"

namespace deltamap::experiments {
namespace {

TEST(BentMapsExperiment, TellsBentMapsFromGoodOnes) {
  const test::TemporaryFolder folder;
  const auto figures = test::figures_of(test::run_lab({"bent-maps", "--out", folder.path().string(), "--seed", "605",
                                                       "--repeats", "1", "--minutes", "6", "--jobs", "1", "--json"}));
  EXPECT_GE(figures.at("bent maps"), 3.0);
  EXPECT_GE(figures.at("of them called false"), 0.75);
  EXPECT_GE(figures.at("good maps"), 1.0);
  EXPECT_EQ(figures.at("of them called good"), 1.0);
}

}  // namespace
}  // namespace deltamap::experiments
