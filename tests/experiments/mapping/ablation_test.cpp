// SPDX-License-Identifier: Apache-2.0
// `deltamap-lab ablation`: what it changes, and what it says of it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "experiments/mapping/ablation_changes.hpp"
#include "experiments/registry.hpp"
#include "tests/support/files/lab_run.hpp"
#include "tests/support/files/temporary_folder.hpp"

namespace deltamap::experiments {
namespace {

const AblationChange& change_named(const std::vector<AblationChange>& changes, const std::string& name) {
  const auto found = std::find_if(changes.begin(), changes.end(), [&](const auto& one) { return one.name == name; });
  EXPECT_NE(found, changes.end()) << name;
  return *found;
}

TEST(Ablation, SwitchesMechanismsOffAndKeysToTheirOtherWord) {
  const auto changes = switched_off({});
  daemon::Settings settings;
  change_named(changes, "off-mapping.gate.enabled").apply(settings);
  change_named(changes, "off-localization.temporary.weighing").apply(settings);
  change_named(changes, "off-refinement").apply(settings);
  EXPECT_FALSE(settings.mapping.store_scan.gate.enabled);
  EXPECT_FALSE(settings.localizer.temporary.weighing);
  EXPECT_EQ(settings.localizer.refinement.steps, 0);
}

TEST(Ablation, HalvesAndDoublesKeysWithinTheirRange) {
  const auto changes = halved_and_doubled({});
  daemon::Settings settings;
  change_named(changes, "half-localization.particles.min").apply(settings);
  change_named(changes, "twice-mapping.persistence_s").apply(settings);
  change_named(changes, "twice-mapping.gate.least_pose_right").apply(settings);
  change_named(changes, "twice-laser.range_deviation_m").apply(settings);
  EXPECT_EQ(settings.localizer.particles.min, 250);
  EXPECT_EQ(settings.localizer.range_deviation_m, 0.03);
  EXPECT_EQ(settings.mapping.store_scan.evidence.passing.persistence_s, 240.0);
  EXPECT_EQ(settings.mapping.store_scan.gate.least_pose_right, 1.0);
  const auto is_of_the_paper = [](const auto& one) { return one.name.find("mapping.paper.") != std::string::npos; };
  EXPECT_TRUE(std::none_of(changes.begin(), changes.end(), is_of_the_paper)) << "method evidence is on";
}

TEST(Ablation, NamesEachChangeOnce) {
  std::set<std::string> names;
  for (const auto& changes : {switched_off({}), halved_and_doubled({})}) {
    for (const AblationChange& one : changes) EXPECT_TRUE(names.insert(one.name).second) << one.name;
  }
}

Outcome outcome_of(const std::string& change, const std::string& seed, double error_m, double recall) {
  return {{{"change", change}, {"what", "of " + change}, {"seed", seed}},
          {{"minutes", 5.0},
           {"error_rms_m", error_m},
           {"jumps", 0.0},
           {"off_share", 0.0},
           {"recall", recall},
           {"precision", 1.0},
           {"skill", 0.5},
           {"gate_shut_while_right", 0.0},
           {"carried_wrong_s", std::nan("")},
           {"carried_cells_astray", std::nan("")},
           {"carried_shut", std::nan("")}},
          {}};
}

TEST(Ablation, PairsWorldsAndMarksWhatIsClear) {
  std::vector<Outcome> outcomes;
  for (const char* seed : {"1", "2", "3", "4", "5"}) outcomes.push_back(outcome_of("delivered", seed, 0.01, 0.9));
  for (const char* seed : {"1", "2", "3", "4", "5"}) outcomes.push_back(outcome_of("off-x", seed, 0.03, 0.9));
  outcomes.push_back(outcome_of("half-y", "2", 0.01, 0.95));
  const Report report = ablation_experiment().report(outcomes);
  const auto& off = report.tables[0].rows.at(0);
  EXPECT_EQ(off[0], "off-x");
  EXPECT_EQ(off[2], "**+0.02 [+0.02, +0.02] 0:5**");
  EXPECT_EQ(off[5], "0");
  const auto& half = report.tables[1].rows.at(0);
  EXPECT_EQ(half[2], "0");
  EXPECT_EQ(half[5], "+0.05 1:0") << "one world has no interval";
}

TEST(Ablation, DrivesAsDeliveredWhateverOnlySays) {
  const test::TemporaryFolder folder;
  const test::ToolRun answer =
      test::run_lab({"ablation", "--out", folder.path().string(), "--seed", "2", "--repeats", "1", "--minutes", "0.2",
                     "--only", "off-slips", "--scenarios", test::source_path("config/scenarios"), "--json"});
  ASSERT_EQ(answer.exit_code, 0) << answer.errors;
  const auto summary = nlohmann::json::parse(answer.output);
  EXPECT_EQ(summary["runs"], 2 * (1 + 3)) << "one world, and carried in three ways";
  EXPECT_EQ(summary["tables"][0]["rows"].size(), 1u);
  EXPECT_EQ(summary["tables"][0]["rows"][0][1], "particles that slip");
}

}  // namespace
}  // namespace deltamap::experiments
