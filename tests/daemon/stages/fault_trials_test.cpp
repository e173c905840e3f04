// SPDX-License-Identifier: Apache-2.0
// Lasers, wheels, mounts and robots that go wrong while the daemon drives in a room that it has a map of: it touches
// nothing, says why it stands, and tells planners that they must not drive. `deltamap-lab faults` has the rest.
#include <gtest/gtest.h>

#include <array>
#include <set>

#include "experiments/closed_loop/fault_trial.hpp"
#include "tests/support/files/source_tree.hpp"
#include "tests/support/worlds/quiet_room.hpp"

namespace deltamap {
namespace {

class FaultTrials : public testing::TestWithParam<std::string_view> {};

TEST_P(FaultTrials, TouchNothing) {
  for (const double before_s : {0.0, 10.0}) {
    const experiments::FaultTrial trial{
        .fault = std::string(GetParam()), .before_s = before_s, .for_s = 15.0, .seed = 1};
    const experiments::LoopOutcome outcome = outcome_of(run_of(trial, test::quiet_room(), {}));
    EXPECT_EQ(outcome.collisions, 0) << "at " << outcome.fastest_collision_m_per_s << " m/s";
    EXPECT_TRUE(before_s == 0.0 || trial.fault.starts_with("mount") || outcome.driven_before_m > 0.5)
        << "it must have been driving: " << outcome.driven_before_m;
  }
}

std::string name_of_trial(const testing::TestParamInfo<std::string_view>& trial) {
  std::string name(trial.param);
  for (char& letter : name) letter = std::isalnum(static_cast<unsigned char>(letter)) != 0 ? letter : '_';
  return name;
}
INSTANTIATE_TEST_SUITE_P(Each, FaultTrials, testing::ValuesIn(experiments::kTrialFaults), name_of_trial);

TEST(FaultTrials, OfALaserThatWasTurnedOnItsMountBeforeTheStartEndBeforeItHasUsedItsRoom) {
  constexpr double kFreeM = 0.3;  // what an operator leaves free around it
  for (const std::string_view fault : {"laser-turned=180", "laser-turned=90", "laser-turned=-90"}) {
    for (std::uint64_t seed = 1; seed <= 7; ++seed) {
      const experiments::FaultTrial trial{.fault = std::string(fault), .before_s = 0.0, .for_s = 60.0, .seed = seed};
      for (const bool has_pilot_gone_wild : {false, true}) {  // by a pose that may fit the turned scans, or by hand
        experiments::LoopRun run = run_of(trial, test::quiet_room(), {});
        run.has_pilot_gone_wild = has_pilot_gone_wild;
        const experiments::LoopOutcome outcome = outcome_of(run);
        EXPECT_EQ(outcome.collisions, 0) << fault << " seed " << seed;
        EXPECT_LT(outcome.moved_m, kFreeM) << fault << " seed " << seed;
      }
    }
  }
}

/// Each scan is the same scene with other noise: no digit repeats, and in a wide hall little is in view.
TEST(FaultTrials, OfALaserThatStandsAreSeenInHallsToo) {
  struct Place {
    const char* scenario;
    double range_m;
  };
  for (const Place& place : {Place{"hall", 8.0}, Place{"demo", 32.0}}) {
    auto scenario = simulation::read_scenario(
        test::source_path(std::string("config/scenarios/").append(place.scenario).append(".yaml")));
    scenario.forklift.reset();
    scenario.laser.max_range_m = place.range_m;
    for (const std::uint64_t seed : {1U, 5U}) {
      const experiments::FaultTrial trial{.fault = "laser-stands", .before_s = 20.0, .for_s = 40.0, .seed = seed};
      const experiments::LoopOutcome outcome = outcome_of(run_of(trial, scenario, {}));
      EXPECT_EQ(outcome.collisions, 0) << place.scenario << " seed " << seed;
      EXPECT_LT(outcome.moved_m, 1.5) << place.scenario << " seed " << seed;
      EXPECT_EQ(name_of(outcome.reason), name_of(navigation::StopReason::kWheelsSpin)) << place.scenario << ' ' << seed;
    }
  }
}

/// A robot that does not obey, and what else goes wrong so much later.
struct Runaway {
  std::string fault;
  std::string also;
  double after_s;
  navigation::StopReason told = navigation::StopReason::kDisobeys;
};

TEST(FaultTrials, TouchNothingWithARobotThatRunsAwayWhateverElseIsWrong) {
  const std::array<Runaway, 7> runaways{{{"goes-at=0.4", "battery=9", 0.0},
                                         {"goes-at=0.4", "battery=9", -4.0},
                                         {"keeps-set-points", "battery=9", 0.0},
                                         {"goes-at=0.4", "laser-turned=180", 0.0, navigation::StopReason::kWheelsSpin},
                                         {"goes-at=-0.09", "", 0.0},
                                         {"goes-at=-0.05", "", 0.0},
                                         {"turns-at=15", "", 0.0}}};
  for (const Runaway& runaway : runaways) {
    const experiments::FaultTrial trial{.fault = runaway.fault, .before_s = 10.0, .for_s = 40.0, .seed = 1};
    experiments::LoopRun run = run_of(trial, test::quiet_room(), {});
    const double begins_s = run.scenario.faults.front().after_s + runaway.after_s;
    if (!runaway.also.empty()) run.scenario.faults.push_back(simulation::fault_order(runaway.also, begins_s));
    const experiments::LoopOutcome outcome = outcome_of(run);
    EXPECT_EQ(outcome.collisions, 0) << runaway.fault << " " << runaway.also;
    EXPECT_EQ(name_of(outcome.reason), name_of(runaway.told)) << runaway.fault << " " << runaway.also;
  }
}

TEST(FaultTrials, SayWhyTheRobotStandsAndThatNobodyMustDriveByItsPose) {
  const std::map<std::string, navigation::StopReason> expected{
      {"laser-repeats", navigation::StopReason::kLaserFrozen},
      {"laser-beyond-maximum", navigation::StopReason::kLaserBlind},
      {"laser-not-valid", navigation::StopReason::kLaserBlind},
      {"laser-covered-ahead=120", navigation::StopReason::kLaserBlind},
      {"laser-random=10", navigation::StopReason::kPoseUnfit},
      {"wheels-spin", navigation::StopReason::kWheelsSpin},
      {"wheels-blocked", navigation::StopReason::kDisobeys},
      {"speed-factor=2", navigation::StopReason::kDisobeys},
      {"charger-plugged", navigation::StopReason::kCharging},
      {"battery=0", navigation::StopReason::kNoBattery},
      {"mount-turned=180", navigation::StopReason::kWayUncovered}};
  for (const auto& [fault, reason] : expected) {
    const experiments::FaultTrial trial{.fault = fault, .before_s = 10.0, .for_s = 25.0, .seed = 1};
    const experiments::LoopOutcome outcome = outcome_of(run_of(trial, test::quiet_room(), {}));
    EXPECT_EQ(outcome.reason, reason) << fault << ": " << name_of(outcome.reason);
    EXPECT_EQ(outcome.may_drive_at_end_share, 0.0) << fault;
  }
}

/// Whoever drives by hand drives on towards a wall that a laser with one range for all does not show.
TEST(FaultTrials, OfOneRangeForAllBeamsStopAPersonsHandAtOnce) {
  for (std::uint64_t seed = 330; seed < 350; ++seed) {
    experiments::LoopRun run;
    run.scenario = test::quiet_room();
    run.scenario.laser.max_range_m = 8.0;
    run.before_s = 12.97;
    run.scenario.faults.push_back(simulation::fault_order("laser-constant=5", experiments::kConnectS + run.before_s));
    run.settings = experiments::fitting(run.scenario);
    run.seed = seed;
    run.for_s = 27.0;
    run.has_pilot_gone_wild = true;
    const experiments::LoopOutcome outcome = outcome_of(run);
    EXPECT_EQ(outcome.collisions, 0) << "seed " << seed << " at " << outcome.fastest_collision_m_per_s << " m/s";
    EXPECT_LT(outcome.stopped_after_s, 0.5) << "seed " << seed;
  }
}

/// 8 m of laser in a hall: when the right scans are back, much of the fan has nothing within reach.
TEST(FaultTrials, AreForgottenWhenTheLaserSeesRightlyAgain) {
  for (const char* fault :
       {"laser-constant=5", "laser-turned=180", "laser-turned=45", "laser-upside-down", "laser-elsewhere=3"}) {
    experiments::LoopRun run;
    run.scenario = simulation::read_scenario(test::source_path("config/scenarios/hall.yaml"));
    run.scenario.forklift.reset();
    run.scenario.laser.max_range_m = 8.0;
    run.scenario.faults.push_back(simulation::fault_order(fault, experiments::kConnectS + 10.0, 8.0));
    run.settings = experiments::fitting(run.scenario);
    run.seed = 4;
    run.before_s = 30.0;
    run.for_s = 30.0;
    const experiments::LoopOutcome outcome = outcome_of(run);
    EXPECT_GT(outcome.moved_m, 2.0) << fault << ": " << name_of(outcome.reason);
    EXPECT_EQ(outcome.collisions, 0) << fault;
  }
}

TEST(FaultTrials, StandAtAGivenPoseThatNoScanHasSupported) {
  experiments::LoopRun run;
  run.scenario = test::quiet_room();
  run.settings = experiments::fitting(run.scenario);
  run.settings.initial_pose = Pose2{10.6, 3.0, 0.0};  // behind the wall: the map knows nothing of where the beams end
  run.for_s = 15.0;
  const experiments::LoopOutcome outcome = outcome_of(run);
  EXPECT_EQ(outcome.moved_m, 0.0);
  EXPECT_EQ(outcome.reason, navigation::StopReason::kStartUnfit) << name_of(outcome.reason);
  EXPECT_EQ(outcome.may_drive_at_end_share, 0.0);
}

TEST(FaultTrials, DriveOnWhereNothingIsWrong) {
  experiments::LoopRun run;
  run.scenario = test::quiet_room();
  run.settings = experiments::fitting(run.scenario);
  run.for_s = 120.0;
  const experiments::LoopOutcome outcome = outcome_of(run);
  EXPECT_EQ(outcome.collisions, 0);
  EXPECT_TRUE(outcome.stops.empty()) << outcome.stops.begin()->first;
  EXPECT_GT(outcome.moved_m, 5.0);
  EXPECT_EQ(outcome.may_drive_at_end_share, 1.0);
}

}  // namespace
}  // namespace deltamap
