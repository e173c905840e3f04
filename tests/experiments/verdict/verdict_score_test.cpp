// SPDX-License-Identifier: Apache-2.0
// What `experiment verdict` counts, on drawn runs.
#include "experiments/verdict/verdict_score.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/geometry/angle.hpp"
#include "core/messages.hpp"
#include "experiments/verdict/verdict_part.hpp"

namespace deltamap::experiments {
namespace {

struct Seen {
  double error_m = 0.0;
  PoseVerdict verdict = PoseVerdict::kRight;
  double pose_right = 1.0;
  LocalizerState state = LocalizerState::kTracking;
  bool drives = true;
};

/// Scans of 1 s, the first ten of them right and before the event.
class DrawnRun {
 public:
  DrawnRun() { then(10, {}); }
  DrawnRun& then(int scans, const Seen& seen) {
    for (int i = 0; i < scans; ++i) {
      if (seen.drives && since_s_ > 0.0) driven_s_ += 1.0;
      table_.add({since_s_, driven_s_, seen.error_m, 0.0, static_cast<double>(seen.state), seen.pose_right, 0.0,
                  static_cast<double>(seen.verdict), 0.0});
      since_s_ += 1.0;
    }
    return *this;
  }
  [[nodiscard]] double number(const std::string& name) const {
    for (const auto& [key, value] : verdict_numbers(table_)) {
      if (key == name) return value;
    }
    ADD_FAILURE() << "no number " << name;
    return 0.0;
  }
  [[nodiscard]] const ScanTable& table() const { return table_; }

 private:
  ScanTable table_{{"since_event_s", "driven_s", "error_m", "heading_error_rad", "state", "pose_right", "map_wrong",
                    "verdict", "map_is_wrong"}};
  double since_s_ = -10.0;
  double driven_s_ = 0.0;
};

constexpr Seen kWrongCalledRight{.error_m = 2.0};
constexpr Seen kWrongUndecided{.error_m = 2.0, .verdict = PoseVerdict::kUndecided, .pose_right = 0.5};

TEST(VerdictScore, CallsAPoseRightWrongOrNeitherByDistanceAndHeading) {
  EXPECT_EQ(pose_truth(0.29, radians(5.9)), PoseTruth::kRight);
  EXPECT_EQ(pose_truth(0.31, 0.0), PoseTruth::kBetween);
  EXPECT_EQ(pose_truth(0.0, radians(-7.0)), PoseTruth::kBetween);
  EXPECT_EQ(pose_truth(0.51, 0.0), PoseTruth::kWrong);
  EXPECT_EQ(pose_truth(0.0, radians(-10.1)), PoseTruth::kWrong);
}

TEST(VerdictScore, MeasuresTheLongestUnbrokenTimeThatAWrongPoseIsCalledRight) {
  DrawnRun run;
  run.then(5, kWrongCalledRight).then(1, kWrongUndecided).then(8, kWrongCalledRight).then(4, kWrongUndecided);
  EXPECT_DOUBLE_EQ(run.number("wrong_called_right_s"), 7.0);
  EXPECT_DOUBLE_EQ(run.number("noticed_s"), 5.0);
  EXPECT_DOUBLE_EQ(run.number("ends_wrong"), 1.0);
}

TEST(VerdictScore, BlamesARightPoseCalledLostOnlyWhereItNeverWasWrong) {
  const Seen lost{.state = LocalizerState::kLost};
  const Seen called_wrong{.verdict = PoseVerdict::kWrong};
  EXPECT_GT(DrawnRun{}.then(5, {}).then(2, lost).then(5, {}).number("right_called_lost_s"), 0.0);
  EXPECT_GT(DrawnRun{}.then(5, {}).then(2, called_wrong).then(5, {}).number("right_called_lost_s"), 0.0);
  EXPECT_EQ(DrawnRun{}.then(5, kWrongUndecided).then(2, lost).then(5, {}).number("right_called_lost_s"), 0.0);
  EXPECT_EQ(DrawnRun{}.then(20, {}).number("right_called_lost_s"), 0.0);
}

TEST(VerdictScore, CountsRecoveryFromTheFirstScanOnFromWhichThePoseStaysRight) {
  const Seen right_undecided{.verdict = PoseVerdict::kUndecided};
  DrawnRun run;
  run.then(6, kWrongUndecided).then(4, right_undecided).then(5, {});
  EXPECT_DOUBLE_EQ(run.number("recovered_s"), 6.0);
  EXPECT_DOUBLE_EQ(run.number("recovered_driving_s"), 6.0);
  EXPECT_DOUBLE_EQ(run.number("recovered_called_right_s"), 10.0);
  EXPECT_TRUE(std::isnan(DrawnRun{}.then(20, kWrongUndecided).number("recovered_s")));
  EXPECT_TRUE(std::isnan(DrawnRun{}.then(20, {}).number("recovered_s"))) << "it never was wrong";
}

TEST(VerdictScore, CallsNothingRecoveredThatIsWrongAgainOrLostOrRightForAMomentOnly) {
  const Seen lost{.state = LocalizerState::kLost};
  EXPECT_TRUE(std::isnan(DrawnRun{}.then(3, kWrongUndecided).then(5, {}).number("recovered_s"))) << "ends too early";
  EXPECT_DOUBLE_EQ(DrawnRun{}.then(3, kWrongUndecided).then(6, {}).number("recovered_s"), 3.0);
  EXPECT_DOUBLE_EQ(DrawnRun{}.then(3, kWrongUndecided).then(3, lost).then(6, {}).number("recovered_s"), 6.0);
  DrawnRun relapse;
  relapse.then(3, kWrongUndecided).then(10, {}).then(1, kWrongUndecided).then(9, {});
  EXPECT_DOUBLE_EQ(relapse.number("recovered_s"), 14.0);
  EXPECT_TRUE(std::isnan(relapse.then(1, kWrongUndecided).number("recovered_s")));
}

TEST(VerdictScore, CountsOnlyTheTimeInWhichTheRobotDrives) {
  Seen standing = kWrongUndecided;
  standing.drives = false;
  DrawnRun run;
  run.then(4, kWrongUndecided).then(20, standing).then(3, kWrongUndecided).then(10, {});
  EXPECT_DOUBLE_EQ(run.number("recovered_s"), 27.0);
  EXPECT_DOUBLE_EQ(run.number("recovered_driving_s"), 7.0);
  EXPECT_DOUBLE_EQ(run.number("recovered_called_right_s"), 7.0);
}

TEST(VerdictScore, ScoresProbabilitiesAfterBrier) {
  DrawnRun run;
  run.then(10, {.pose_right = 0.9}).then(10, {.error_m = 2.0, .pose_right = 0.2});
  run.then(10, {.error_m = 0.4, .pose_right = 0.0});  // neither right nor wrong
  EXPECT_NEAR(run.number("pose_brier"), 0.5 * (0.01 + 0.04), 1e-9);
  const Reliability pose = pose_reliability(run.table());
  EXPECT_DOUBLE_EQ(pose.scans, 20.0);
  EXPECT_DOUBLE_EQ(pose.bins[9].came / pose.bins[9].scans, 1.0);
  EXPECT_DOUBLE_EQ(pose.bins[2].came / pose.bins[2].scans, 0.0);
}

TEST(VerdictScore, BoundsAShareAfterWilson) {
  EXPECT_NEAR(wilson_upper(0.0, 100.0), 0.03699, 1e-4);
  EXPECT_NEAR(wilson_upper(5.0, 100.0), 0.1118, 1e-4);
  EXPECT_NEAR(wilson_upper(10.0, 10.0), 1.0, 1e-9);
  EXPECT_TRUE(std::isnan(wilson_upper(0.0, 0.0)));
}

TEST(VerdictScore, SumsUpRuns) {
  const auto outcome = [](const DrawnRun& run, bool ambiguous = false) {
    Outcome made;
    made.numbers = verdict_numbers(run.table());
    made.numbers.emplace_back("ambiguous", ambiguous ? 1.0 : 0.0);
    made.numbers.emplace_back("unique_after_s", ambiguous ? std::nan("") : 6.0);
    made.scans = run.table();
    return made;
  };
  const std::vector<Outcome> outcomes{outcome(DrawnRun{}.then(30, {})),
                                      outcome(DrawnRun{}.then(10, kWrongCalledRight).then(20, {})),
                                      outcome(DrawnRun{}.then(30, kWrongUndecided), true)};
  const VerdictPart all{outcomes, [](const Outcome&) { return true; }};
  EXPECT_DOUBLE_EQ(all.runs(), 3.0);
  EXPECT_DOUBLE_EQ(all.once_wrong(), 2.0);
  EXPECT_DOUBLE_EQ(all.wrong_called_right(), 1.0);
  EXPECT_DOUBLE_EQ(all.recovered_in(30.0), 1.0);
  EXPECT_DOUBLE_EQ(all.recovered_in(5.0), 0.0);
  EXPECT_DOUBLE_EQ(all.called_right_again_in(30.0), 1.0);
  EXPECT_DOUBLE_EQ(all.recovered_in_after_unique(5.0), 1.0);
  EXPECT_DOUBLE_EQ(all.ambiguous(), 1.0);
  EXPECT_DOUBLE_EQ(all.recovery_quantile_s(0.5), 10.0);
  EXPECT_TRUE(std::isnan(all.recovery_quantile_s(0.95))) << "one never recovered";
}

}  // namespace
}  // namespace deltamap::experiments
