// SPDX-License-Identifier: Apache-2.0
// The experiments that drive in a changing world, minutes in place of hours: no figure of Δ-mapping gets far away from
// what docs/results/experiments.md says without a test that fails. Limits leave room for the chance of a short drive.
#include <gtest/gtest.h>

#include <map>
#include <string>
#include <vector>

#include "tests/support/files/lab_run.hpp"
#include "tests/support/files/temporary_folder.hpp"

namespace deltamap::experiments {
namespace {

using Figures = std::map<std::string, double>;

Figures figures_of(const std::string& name, const std::string& only, double minutes, int seed = 1) {
  const test::TemporaryFolder folder;
  return test::figures_of(
      test::run_experiment(name, folder.path().string(), std::to_string(minutes),
                           {"--only", only, "--seed", std::to_string(seed), "--jobs", "1", "--json"}));
}

void expect_followed_changes(const Figures& of) {
  EXPECT_GE(of.at("hall: skill, least"), 0.75);
  EXPECT_LE(of.at("hall: error_p99_m, most"), 0.2);
  EXPECT_GE(of.at("hall: recall, mean"), 0.8);
  EXPECT_EQ(of.at("hall: cells_written_astray, most"), 0.0);
  EXPECT_EQ(of.at("hall: walls_kept, least"), 1.0);
}

TEST(ShortDrive, FollowsAContainerAMinute) {  // table2, fig10-12
  const Figures of = figures_of("table2", "evidence", 10.0);
  expect_followed_changes(of);
  EXPECT_LE(of.at("hall: acceptance_perfect - acceptance, most"), 0.003);
  EXPECT_GE(of.at("hall: acceptance_solid, least"), 0.97);
  EXPECT_LE(of.at("hall: error_mean_m, most"), 0.05);
  EXPECT_EQ(of.at("hall: not_tracking, most"), 0.0);
  EXPECT_GE(of.at("hall: precision, mean"), 0.9);
  EXPECT_LE(of.at("hall: layer_median_s, mean"), 3.0);
  EXPECT_LE(of.at("hall: wall_drift_m, most"), 0.02);
}

TEST(ShortDrive, FollowsChangesAtThreeTimesTheSpeed) {  // fast
  const Figures of = figures_of("fast", "evidence", 10.0);
  expect_followed_changes(of);
  EXPECT_LE(of.at("hall: follow_median_s, mean"), 8.0);
}

TEST(ShortDrive, WritesLittleOfWhomItMeets) {  // passers; the paper's method draws 0.7 of the override rule's ghosts
  const Figures of = figures_of("passers", "evidence", 10.0);
  EXPECT_LE(of.at("passers: passer_ghosts_of_override, most"), 0.1);
  EXPECT_LE(of.at("passers: error_p99_m, most"), 0.2);
  EXPECT_EQ(of.at("passers: cells_written_astray, most"), 0.0);
  EXPECT_GE(of.at("passers: walls_kept, least"), 0.999);
}

TEST(ShortDrive, LeavesAloneWhatDoesNotChange) {  // static
  for (const std::string world : {"racks", "doors"}) {
    const Figures of = figures_of("static", world, 6.0);
    EXPECT_LE(of.at(world + ": writes_per_cell_hour, most"), 0.1);
    EXPECT_EQ(of.at(world + ": walls_kept, least"), 1.0);
    EXPECT_EQ(of.at(world + ": cells_written_astray, most"), 0.0);
  }
}

TEST(ShortDrive, IsNotCarriedAwayByContainersThatCreep) {  // creep
  const Figures of = figures_of("creep", "evidence", 10.0);
  EXPECT_LE(of.at("creep: wall_drift_m, most"), 0.02);
  EXPECT_LE(of.at("creep: error_mean_m, most"), 0.05);
  EXPECT_LE(of.at("creep: error_p99_m, most"), 0.2);
  EXPECT_EQ(of.at("creep: cells_written_astray, most"), 0.0);
}

TEST(ShortDrive, MendsAHallOfWhichHalfHasChanged) {  // changed-start
  const Figures of = figures_of("changed-start", "50%-seed1-evidence", 8.0);
  EXPECT_GE(of.at("50%: skill, least"), 0.8);
  EXPECT_LE(of.at("50%: longest_start_check_s, most"), 5.0);
  EXPECT_EQ(of.at("50%: not_tracking, most"), 0.0);
  EXPECT_EQ(of.at("50%: cells_written_astray, most"), 0.0);
}

TEST(ShortDrive, KeepsItsPoseWhileContainersAreShifted) {  // live-map
  const Figures of = figures_of("live-map", "evidence", 8.0);
  EXPECT_LE(of.at("80m: error_rms_m, most"), 0.03);
  EXPECT_LE(of.at("8m: error_rms_m, most"), 0.08);
  EXPECT_GE(of.at("80m: recall, mean"), 0.85) << "six of seven";
  for (const std::string range : {"80m", "8m"}) EXPECT_EQ(of.at(range + ": not_tracking, most"), 0.0);
}

TEST(ShortDrive,
     KeepsItsPoseInAHallThatItsMapKnowsNoMore) {  // shifted-hall, 45 min in: containers fit better elsewhere
  const Figures of = figures_of("shifted-hall", "8m-stale", 48.0, 3);
  EXPECT_LE(of.at("8m-stale: RMSE of the worst drive"), 0.03);
  EXPECT_EQ(of.at("8m-stale: jumps away from a right pose, most"), 0.0);
  EXPECT_EQ(of.at("8m-stale: time off by more than 0.5 m"), 0.0);
}

TEST(ShortDrive, GoesOnAfterTenRestarts) {  // endurance
  const Figures of = figures_of("endurance", "24h", 10.0);
  EXPECT_EQ(of.at("24h: not_tracking, most"), 0.0);
  EXPECT_LE(of.at("24h: error_p99_m, most"), 0.2);
  EXPECT_LE(of.at("24h: acceptance_perfect - acceptance, most"), 0.004);
  EXPECT_LE(of.at("24h: wall_drift_m, most"), 0.02);
  EXPECT_EQ(of.at("24h: cells_written_astray, most"), 0.0);
}

TEST(ShortDrive, LeavesNothingWrittenWhereItWasCarried) {  // gate
  const Figures of = figures_of("gate", "bay", 5.0);
  const std::map<std::string, double> to_keep_out{{"hall", 1000.0}, {"depot", 500.0}, {"changed", 1000.0}};
  for (const auto& [world, cells] : to_keep_out) {  // in the depot the robot is soon found
    const std::string written = world + ": cells written while the pose was off by more than 0.3 m";
    const double without_gate = of.at(written + ", without the gate");
    EXPECT_GT(without_gate, cells) << "there was something to keep out";
    EXPECT_LE(of.at(written), 1e-4 * without_gate);
    EXPECT_EQ(of.at(world + ": cells written while off by more than 0.3 m that are there 60 s later"), 0.0);
  }
}

TEST(ShortDrive, WritesNothingInFrozenZonesAndKeepsThePoseBesideIgnoredOnes) {  // zones
  const Figures of = figures_of("zones", "seed1", 6.0);
  EXPECT_EQ(of.at("cells written within frozen zones"), 0.0);
  EXPECT_GT(of.at("cells written beside frozen zones"), 0.0);
}

}  // namespace
}  // namespace deltamap::experiments
