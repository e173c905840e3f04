// SPDX-License-Identifier: Apache-2.0
// `deltamap-lab unseen`: what it counts, on made-up drives, and what it refuses.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "experiments/seed_summary.hpp"
#include "experiments/watch/pose_course.hpp"
#include "tests/support/files/lab_run.hpp"
#include "tests/support/files/temporary_folder.hpp"
#include "tests/support/files/text_file.hpp"

namespace deltamap::experiments {
namespace {

using test::content_of;

constexpr double kScanEvery_s = 0.1;

double number(const PoseCourse& course, const std::string& name) {
  for (const auto& [key, value] : course.numbers()) {
    if (key == name) return value;
  }
  ADD_FAILURE() << "there is no " << name;
  return 0.0;
}

/// A drive along x; the estimate is beside the truth by so much.
class MadeUpDrive {
 public:
  explicit MadeUpDrive(bool knows_start, const Pose2& mount = {}) : course{knows_start, mount} {}

  void scans(int count, double error_m, LocalizerState state = LocalizerState::kTracking,
             mapping::gate::GateReason gate = mapping::gate::GateReason::kOpen, const Befallen& befallen = {}) {
    for (int i = 0; i < count; ++i) {
      Mapped scan;
      scan.passed_s = passed_s;
      scan.map_from_robot = {0.5 * passed_s, 0.0, 0.0};
      scan.estimate.map_from_robot = {0.5 * passed_s, error_m, 0.0};
      scan.estimate.covariance = PoseCovariance::Identity() * 0.01;
      scan.estimate.state = state;
      scan.awareness.gate = gate;
      scan.slips = std::exchange(slips, 0);
      course.observe(scan, befallen);
      passed_s += kScanEvery_s;
    }
  }

  PoseCourse course;
  double passed_s = 0.0;
  int slips = 0;
};

TEST(PoseCourse, CountsErrorsStretchesAndJumps) {
  MadeUpDrive drive{true};
  drive.scans(100, 0.0);
  drive.scans(30, 0.6);  // a jump, off for 3 s
  drive.scans(100, 0.0);
  drive.scans(10, 0.4);  // slowly: no jump
  drive.scans(60, 0.8);  // off for 6 s
  drive.scans(100, 0.0);
  EXPECT_EQ(number(drive.course, "jumps"), 1.0);
  EXPECT_EQ(number(drive.course, "stretches_off"), 1.0);
  EXPECT_NEAR(number(drive.course, "off_s"), 9.0, 1e-6);
  EXPECT_NEAR(number(drive.course, "longest_off_s"), 6.0, 1e-6);
  EXPECT_NEAR(number(drive.course, "off_share"), 9.0 / 39.9, 1e-6);
  EXPECT_NEAR(number(drive.course, "first_off_s"), 10.0, 1e-6);
  EXPECT_NEAR(number(drive.course, "error_most_m"), 0.8, 1e-6);
  EXPECT_NEAR(number(drive.course, "error_rms_m"), std::sqrt((30 * 0.36 + 10 * 0.16 + 60 * 0.64) / 400.0), 1e-6);
  EXPECT_TRUE(std::isnan(number(drive.course, "found_after_s"))) << "the start was given";
}

TEST(PoseCourse, JudgesTheCovarianceAndApartWhatFollowsASlip) {
  MadeUpDrive drive{true};
  drive.scans(300, 0.0);
  drive.slips = 1;
  drive.scans(60, 0.3);  // three deviations of 0.1 m: outside
  drive.scans(40, 0.1);
  drive.scans(600, 0.0);
  EXPECT_NEAR(number(drive.course, "inside_95"), 940.0 / 1000.0, 1e-6);
  EXPECT_NEAR(number(drive.course, "inside_95_after_slip"), 540.0 / 600.0, 0.002) << "of a minute";
  EXPECT_EQ(number(drive.course, "slips"), 1.0);
}

TEST(PoseCourse, JudgesTheCovarianceByTheLaserAndNotByAMountThatNobodyCanKnow) {
  MadeUpDrive drive{true, {0.3, 0.0, 0.0}};  // scans tell a mount in the robot's middle
  drive.scans(100, 0.0);
  EXPECT_EQ(number(drive.course, "inside_95"), 0.0) << "the laser is 0.3 m ahead of where it is believed";
  EXPECT_NEAR(number(drive.course, "laser_error_rms_m"), 0.3, 1e-6);
  EXPECT_EQ(number(drive.course, "error_rms_m"), 0.0);
}

TEST(PoseCourse, CountsHowLongTheGateIsShutWhileThePoseIsRight) {
  MadeUpDrive drive{true};
  drive.scans(100, 0.05);
  drive.scans(50, 0.05, LocalizerState::kTracking, mapping::gate::GateReason::kConfirming);
  drive.scans(50, 0.3, LocalizerState::kTracking, mapping::gate::GateReason::kDoubtful);  // not right: may be shut
  drive.scans(50, 0.05, LocalizerState::kLost, mapping::gate::GateReason::kLost);
  EXPECT_NEAR(number(drive.course, "gate_shut_while_right"), 100.0 / 199.0, 1e-6);
  EXPECT_NEAR(number(drive.course, "searching_while_near_s"), 5.0, 1e-6);
}

TEST(PoseCourse, FindsAStartOnlyOnceItIsTrackedAndRightForAWhile) {
  MadeUpDrive drive{false};
  drive.scans(50, 20.0, LocalizerState::kGlobal);
  drive.scans(30, 20.0);  // tracks a wrong place for 3 s
  drive.scans(40, 0.1);   // right by chance for 4 s
  drive.scans(20, 5.0, LocalizerState::kGlobal);
  EXPECT_EQ(number(drive.course, "start_found"), 0.0);
  EXPECT_EQ(drive.course.cause(), "start not found");
  drive.scans(200, 0.1);
  EXPECT_EQ(number(drive.course, "start_found"), 1.0);
  EXPECT_NEAR(number(drive.course, "found_after_s"), 14.0, 1e-6);
  EXPECT_NEAR(number(drive.course, "wrong_before_found_s"), 3.0, 1e-6);
  EXPECT_NEAR(number(drive.course, "error_most_m"), 0.1, 1e-6) << "what was before does not count";
  EXPECT_EQ(drive.course.cause(), "");
}

TEST(PoseCourse, NamesWhatHappenedShortlyBeforeThePoseWentWrong) {
  MadeUpDrive drive{true};
  drive.scans(10, 0.0, LocalizerState::kTracking, mapping::gate::GateReason::kOpen, {.person_near = true});
  drive.scans(250, 0.0);  // the person has long gone
  drive.slips = 1;
  drive.scans(10, 0.0);
  drive.passed_s += 4.0;  // without scans
  drive.scans(10, 0.0, LocalizerState::kTracking, mapping::gate::GateReason::kOpen, {.change_in_view = true});
  drive.scans(10, 0.9);
  EXPECT_EQ(drive.course.cause(), "change in view, slip, gap");
  EXPECT_EQ(number(drive.course, "jumps"), 1.0);
  drive.scans(10, 0.0);
  drive.passed_s += 4.0;
  drive.scans(10, 0.9);
  EXPECT_EQ(number(drive.course, "jumps"), 1.0) << "who was blind has not jumped";
  EXPECT_EQ(number(drive.course, "gaps"), 2.0);
}

TEST(SeedSummary, GivesMedianNineOfTenAndWorstByWhatIsBetter) {
  const std::vector<double> values{5.0, 1.0, 2.0, std::nan(""), 3.0, 4.0, 6.0, 7.0, 8.0, 9.0, 10.0};
  const Spread less = spread_of(values, Better::kLess);
  EXPECT_EQ(less.median, 5.0);
  EXPECT_EQ(less.nine_of_ten, 9.0);
  EXPECT_EQ(less.worst, 10.0);
  const Spread more = spread_of(values, Better::kMore);
  EXPECT_EQ(more.median, 6.0);
  EXPECT_EQ(more.nine_of_ten, 2.0);
  EXPECT_EQ(more.worst, 1.0);
  EXPECT_TRUE(std::isnan(spread_of({}, Better::kLess).median));
}

TEST(SeedSummary, AsksTheWorstSeedAndLeavesOutWhatNobodyHasMeasured) {
  const std::vector<Outcome> outcomes{{{}, {{"recall", 0.99}, {"none", std::nan("")}}, ScanTable{{}}},
                                      {{}, {{"recall", 0.8}, {"none", std::nan("")}}, ScanTable{{}}}};
  const std::vector<Figure> figures = spread_figures({{"recall", "", Better::kMore, 0.9, {}, 0.9}, {"none"}}, outcomes);
  ASSERT_EQ(figures.size(), 3U);
  EXPECT_EQ(figures[0].name, "recall, median");
  EXPECT_TRUE(figures[0].target->is_met_by(figures[0].value));
  EXPECT_FALSE(figures[1].target.has_value());
  EXPECT_FALSE(figures[2].target->is_met_by(figures[2].value));
}

test::ToolRun unseen(const std::string& out, const std::vector<std::string>& more) {
  std::vector<std::string> words{"unseen", "--out", out};
  words.insert(words.end(), more.begin(), more.end());
  return test::run_lab(words);
}

TEST(Unseen, LeavesALineForEverySeedWithItsKindAndItsFigures) {
  const test::TemporaryFolder folder;
  const test::ToolRun answer = unseen(folder.path().string(), {"--quick", "--minutes", "0.5"});
  ASSERT_EQ(answer.exit_code, 0) << answer.errors;
  const std::string table = content_of(folder.path() / "unseen.csv");
  EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 4);
  EXPECT_NE(table.find("run,seed,layout,laser,map,start,cause,"), std::string::npos);
  for (const char* column : {"error_rms_m", "recall", "precision", "skill", "gate_shut_while_right", "inside_95",
                             "cells_written_astray", "wall_drift_m", "found_after_s", "odometry_lag_s"}) {
    EXPECT_NE(table.find(column), std::string::npos) << column;
  }
  const std::string page = content_of(folder.path() / "index.html");
  EXPECT_NE(page.find("Error of the pose in the worst seeds"), std::string::npos);
  EXPECT_NE(page.find("<figcaption>Seed 1: robot green, believed magenta"), std::string::npos);
}

TEST(Unseen, NeverUpdatesTheMapWhereMappingIsSwitchedOff) {
  const test::TemporaryFolder folder;
  const test::ToolRun answer = unseen(
      folder.path().string(), {"--repeats", "1", "--seed", "2", "--minutes", "0.5", "--set", "mapping.enabled=false"});
  ASSERT_EQ(answer.exit_code, 0) << answer.errors;
  EXPECT_EQ(answer.output.find("recall"), std::string::npos);
  EXPECT_NE(answer.output.find("error_rms_m, median"), std::string::npos);
}

TEST(Unseen, MixesNoDevelopmentSeedsWithThoseOfFinalFigures) {
  const test::TemporaryFolder folder;
  for (const std::vector<std::string>& seeds : {std::vector<std::string>{"--seed", "0", "--repeats", "1"},
                                                {"--seed", "990", "--repeats", "20"},
                                                {"--seed", "1000", "--repeats", "61"},
                                                {"--seed", "5000", "--repeats", "1"}}) {
    const test::ToolRun answer = unseen((folder.path() / "out").string(), seeds);
    EXPECT_EQ(answer.exit_code, 2);
    EXPECT_EQ(std::count(answer.errors.begin(), answer.errors.end(), '\n'), 1) << answer.errors;
    EXPECT_NE(answer.errors.find("1 to 999 for development"), std::string::npos) << answer.errors;
  }
}

}  // namespace
}  // namespace deltamap::experiments
