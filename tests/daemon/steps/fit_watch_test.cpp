// SPDX-License-Identifier: Apache-2.0
// A pose that fits nowhere and a map of somewhere else are told, once and at once.
#include "daemon/steps/fit_watch.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace deltamap::daemon {
namespace {

constexpr double kPeriod_s = 0.2;

/// What is said while scans of this fit come, 0.1 m of driving apart.
class Watched {
 public:
  explicit Watched(bool is_given) : watch_{is_given} {}

  /// It does not move while it is held.
  void hold() { step_m_ = 0.0; }

  std::string after(double duration_s, std::optional<double> fit, LocalizerState state = LocalizerState::kTracking) {
    return after(duration_s, FitWatch::Seen{fit, fit}, state);
  }
  std::string after(double duration_s, const FitWatch::Seen& seen, LocalizerState state = LocalizerState::kTracking) {
    std::string said;
    for (double t = 0.0; t < duration_s - 1e-9; t += kPeriod_s) {
      tracked_.scan.time += duration_from_seconds(kPeriod_s);
      tracked_.odom_from_robot.x += step_m_;
      tracked_.estimate.state = state;
      const LogLine line = watch_.observe(tracked_, seen);
      if (!line.text.empty()) said += (line.is_warning ? "warning: " : "") + line.text + "\n";
    }
    return said;
  }
  /// No scan comes, or a clock is set.
  void skip(double duration_s) { tracked_.scan.time += duration_from_seconds(duration_s); }
  void call(PoseVerdict verdict) { tracked_.estimate.belief.verdict = verdict; }
  void relocalize() { watch_.relocalized(); }
  [[nodiscard]] bool start_fits() const { return watch_.start_fits(); }

 private:
  double step_m_ = 0.1;
  FitWatch watch_;
  TrackedScan tracked_;
};

TEST(FitWatch, AStartPoseThatDoesNotFitIsToldAfterTheFirstScans) {
  EXPECT_EQ(Watched{true}.after(1.0, 0.23),
            "warning: the start pose does not fit: 23 % of the beams end where the map says; the map may be another, "
            "or the pose "
            "wrong: say where the robot stands by `deltamap ctl relocalize X,Y,DEG`\n");
  EXPECT_EQ(Watched{true}.after(10.0, 0.9), "");
  EXPECT_EQ(Watched{false}.after(1.0, 0.23), "") << "nobody gave one";
}

TEST(FitWatch, RangesOfAnotherScaleAreToldOnce) {
  Watched watched{true};
  EXPECT_EQ(watched.after(5.0, 0.9), "");
  const FitWatch::Seen seen{0.7, 0.7, localization::sensor::OtherScale{1.1, 0.88, 0.72}};
  EXPECT_EQ(watched.after(5.0, seen),
            "warning: ranges and map differ in scale: with ranges 1.10 times as long the map explains 88 % of the "
            "beams, as they are 72 %; look at the laser's unit, and at 'resolution' in the map's YAML\n");
  EXPECT_EQ(watched.after(5.0, FitWatch::Seen{0.7, 0.7, localization::sensor::OtherScale{1.25, 0.9, 0.7}}), "");
}

TEST(FitWatch, ScansWithoutAReturnSayNothingOfTheStartPose) {
  Watched watched{true};
  EXPECT_EQ(watched.after(5.0, std::nullopt), "");
  EXPECT_NE(watched.after(1.0, 0.1), "");
}

TEST(FitWatch, AGivenPoseDoesNotFitUntilScansSupportIt) {
  Watched watched{true};
  EXPECT_FALSE(watched.start_fits()) << "before any scan";
  (void)watched.after(30.0, std::nullopt);
  EXPECT_FALSE(watched.start_fits()) << "nothing came back";
  (void)watched.after(kPeriod_s, 0.9);
  EXPECT_TRUE(watched.start_fits());
  (void)watched.after(10.0, 0.9);
  (void)watched.after(60.0, FitWatch::Seen{std::nullopt, 0.0});
  EXPECT_TRUE(watched.start_fits()) << "it has driven on into what was never mapped";
  EXPECT_TRUE(Watched{false}.start_fits()) << "nobody gave one";
}

TEST(FitWatch, WhatTheMapKnowsNothingOfIsNoSupport) {
  Watched nowhere{true};
  (void)nowhere.after(kPeriod_s, 0.2);
  EXPECT_NE(nowhere.after(30.0, FitWatch::Seen{std::nullopt, 0.0}), "");
  EXPECT_FALSE(nowhere.start_fits());
  Watched chance_hits{true};
  (void)chance_hits.after(30.0, FitWatch::Seen{1.0, 0.2});
  EXPECT_FALSE(chance_hits.start_fits()) << "all other beams end where nothing is known";
}

TEST(FitWatch, AGivenPoseThatTheFirstScanFitsByChanceIsRefutedByTheNext) {
  Watched watched{true};
  (void)watched.after(kPeriod_s, 0.7);
  EXPECT_TRUE(watched.start_fits());
  (void)watched.after(30.0, 0.55);
  EXPECT_FALSE(watched.start_fits());
}

TEST(FitWatch, AGivenPoseThatIsCalledRightFits) {
  Watched watched{true};
  (void)watched.after(5.0, 0.3);
  EXPECT_FALSE(watched.start_fits());
  watched.call(PoseVerdict::kRight);
  (void)watched.after(kPeriod_s, 0.3);
  EXPECT_TRUE(watched.start_fits());
}

TEST(FitWatch, ARelocalizedPoseIsProvenByItsOwnScansAlone) {
  for (const bool is_given : {true, false}) {
    Watched watched{is_given};
    (void)watched.after(60.0, 0.95);
    ASSERT_TRUE(watched.start_fits());
    watched.relocalize();
    EXPECT_FALSE(watched.start_fits());
    EXPECT_EQ(watched.after(5.0, 0.45).rfind("warning: the start pose does not fit: 45 %", 0), 0u);
    EXPECT_EQ(watched.after(60.0, 0.55), "");
    EXPECT_FALSE(watched.start_fits());
    watched.relocalize();
    EXPECT_EQ(watched.after(5.0, 0.95), "");
    EXPECT_TRUE(watched.start_fits());
  }
}

TEST(FitWatch, AForeignMapIsToldOnceAfterAMinuteOfSearching) {
  Watched watched{false};
  EXPECT_EQ(watched.after(59.0, 0.45, LocalizerState::kGlobal), "");
  const std::string said = watched.after(60.0, 0.45, LocalizerState::kGlobal);
  EXPECT_EQ(
      said.rfind("warning: no place in the map has been sure for 60 s and 30 m: 45 % of the beams fit at the best one",
                 0),
      0u)
      << said;
  EXPECT_EQ(std::count(said.begin(), said.end(), '\n'), 1);
  EXPECT_EQ(watched.after(5.0, 0.9), "the map fits again\n");
}

TEST(FitWatch, ASearchThatNobodyDrivesForIsToldToo) {
  Watched watched{false};
  watched.hold();
  EXPECT_EQ(watched.after(59.0, std::nullopt, LocalizerState::kGlobal), "");
  const std::string said = watched.after(60.0, std::nullopt, LocalizerState::kGlobal);
  EXPECT_EQ(said.rfind("warning: no place in the map has been sure for 60 s and 0 m: is it the map", 0), 0u) << said;
  EXPECT_EQ(watched.after(100.0, 0.2, LocalizerState::kTracking), "") << "one who stands in front of a sure pose";
}

TEST(FitWatch, AGapWithoutScansIsNoTimeInWhichNothingFits) {
  Watched watched{false};
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(watched.after(15.0, 0.2, LocalizerState::kGlobal), "");
    watched.skip(1000001.0);
  }
  EXPECT_NE(watched.after(20.0, 0.2, LocalizerState::kGlobal).find("sure for 60 s"), std::string::npos);
}

TEST(FitWatch, APoseThatIsTrackedAndDoesNotFitForAMinuteIsToldToo) {
  Watched watched{false};
  EXPECT_EQ(watched.after(100.0, 0.9), "");
  EXPECT_NE(watched.after(70.0, 0.2), "");
}

TEST(FitWatch, ARefusedStartIsAWarning) { EXPECT_TRUE(refused_start_line().is_warning); }

TEST(FitWatch, TheFitIsPutIntoWords) {
  EXPECT_EQ(fit_words(0.934), "93 % of its beams fit");
  EXPECT_EQ(fit_words(0.12), "only 12 % of its beams fit: is it the right place, and the right map?");
  EXPECT_EQ(fit_words(std::nullopt), "no beam came back, so that nothing tells whether it fits");
}

TEST(FitWatch, APoseThatFewOrNoBeamsFitIsInDoubt) {
  EXPECT_FALSE(is_in_doubt(0.93));
  EXPECT_TRUE(is_in_doubt(0.12));
  EXPECT_TRUE(is_in_doubt(std::nullopt));
}

}  // namespace
}  // namespace deltamap::daemon
