// SPDX-License-Identifier: Apache-2.0
#include "localization/belief/fit_monitor.hpp"

#include <gtest/gtest.h>

namespace deltamap::localization::belief {
namespace {

particles::ParticleCluster certain() {
  particles::ParticleCluster best;
  best.weight = 1.0;
  best.covariance = Eigen::Vector3d{1e-4, 1e-4, 1e-4}.asDiagonal();
  return best;
}

/// Scans at 5 Hz of a robot at 0.4 m/s; where they fit badly, another place explains them.
LocalizerState after(FitMonitor& monitor, double duration_s, double fit, double speed_m_per_s = 0.4,
                     bool beaten = true) {
  FitMonitor::Observation scan{.passed_s = 0.2, .driven_m = 0.2 * speed_m_per_s, .turned_rad = 0.0, .fit = fit};
  scan.beaten = beaten;
  LocalizerState state = monitor.state();
  for (int i = 0; i < static_cast<int>(duration_s * 5.0); ++i) state = monitor.observe(scan, certain());
  return state;
}

FitMonitor tracking() {
  FitMonitor monitor{{}};
  monitor.start(LocalizerState::kTracking);
  (void)after(monitor, 5.0, 0.95);
  return monitor;
}

TEST(FitMonitor, TakesAMuchChangedViewForNoLoss) {
  FitMonitor monitor = tracking();
  EXPECT_EQ(after(monitor, 600.0, 0.5), LocalizerState::kTracking);
  EXPECT_EQ(after(monitor, 8.0, 0.1), LocalizerState::kTracking);
  EXPECT_EQ(after(monitor, 5.0, 0.9), LocalizerState::kTracking);
}

TEST(FitMonitor, IsLostAfterALongMisfitAndSearchesOnlyAfterDrivingOn) {
  FitMonitor monitor = tracking();
  EXPECT_EQ(after(monitor, 95.0, 0.15, 0.4, false), LocalizerState::kLost);
  EXPECT_EQ(after(monitor, 60.0, 0.15, 0.0, false), LocalizerState::kLost);
  EXPECT_EQ(after(monitor, 20.0, 0.15, 0.4, false), LocalizerState::kGlobal);
}

TEST(FitMonitor, BlamesTheMapForAMisfitOfAMinute) {
  FitMonitor monitor = tracking();
  EXPECT_EQ(after(monitor, 60.0, 0.15, 0.4, false), LocalizerState::kTracking);
  EXPECT_TRUE(monitor.suspicious()) << "looks elsewhere all the same";
  EXPECT_NE(after(monitor, 60.0, 0.15, 0.4, false), LocalizerState::kTracking) << "nothing has fitted for long";
}

TEST(FitMonitor, IsNeverLostByMisfitWhileSurfacesHoldThePose) {
  FitMonitor monitor = tracking();
  for (int i = 0; i < 1000; ++i) (void)monitor.observe({.passed_s = 0.2, .fit = 0.1, .is_held = true}, certain());
  EXPECT_EQ(monitor.state(), LocalizerState::kTracking);
  for (int i = 0; i < 1000; ++i) (void)monitor.observe({.passed_s = 0.2, .fit = 0.1}, certain());
  EXPECT_EQ(monitor.state(), LocalizerState::kLost);
}

TEST(FitMonitor, IsNotLostByMisfitWhereAllBeamsTogetherSupportThePose) {
  FitMonitor monitor = tracking();
  const FitMonitor::Observation scan{.passed_s = 0.2, .fit = 0.35, .trust = 0.95};
  for (int i = 0; i < 1000; ++i) {
    ASSERT_EQ(monitor.observe(scan, certain()), LocalizerState::kTracking) << "after " << 0.2 * i << " s";
  }
}

TEST(FitMonitor, SuspectsAPoseThatIsSurelyWrong) {
  FitMonitor monitor = tracking();
  EXPECT_FALSE(monitor.suspicious());
  (void)monitor.observe({.passed_s = 0.2, .fit = 0.9, .trust = 0.01}, certain());
  EXPECT_TRUE(monitor.suspicious());
  (void)monitor.observe({.passed_s = 0.2, .fit = 0.9, .trust = 0.5}, certain());
  EXPECT_FALSE(monitor.suspicious());
}

TEST(FitMonitor, TracksAgainWhereTheViewFitsAgain) {
  FitMonitor monitor = tracking();
  EXPECT_EQ(after(monitor, 95.0, 0.1, 0.0, false), LocalizerState::kLost);
  EXPECT_EQ(after(monitor, 10.0, 0.9, 0.4, false), LocalizerState::kTracking);
}

TEST(FitMonitor, EndsAGlobalSearchOnlyAfterSeeingEnough) {
  FitMonitor monitor{{}};
  monitor.start(LocalizerState::kGlobal);
  EXPECT_EQ(after(monitor, 30.0, 0.95, 0.0), LocalizerState::kGlobal);
  EXPECT_EQ(after(monitor, 10.0, 0.95), LocalizerState::kTracking);
}

TEST(FitMonitor, DoesNotEndAGlobalSearchWithTwoPlacesLeft) {
  FitMonitor monitor{{}};
  monitor.start(LocalizerState::kGlobal);
  particles::ParticleCluster torn = certain();
  torn.weight = 0.6;
  LocalizerState state{};
  for (int i = 0; i < 100; ++i) state = monitor.observe({0.2, 0.1, 0.0, 0.9}, torn);
  EXPECT_EQ(state, LocalizerState::kGlobal);
}

TEST(FitMonitor, EndsASearchWhereLittleFitsOnlyAfterALongDrive) {
  FitMonitor monitor{{}};
  monitor.start(LocalizerState::kGlobal);
  EXPECT_EQ(after(monitor, 15.0, 0.2), LocalizerState::kGlobal) << "6 m";
  EXPECT_EQ(after(monitor, 10.0, 0.2), LocalizerState::kTracking) << "10 m: one place alone is left, the map is old";
}

TEST(FitMonitor, SearchesAtOnceWhereAnotherPlaceHasBeatenTheBelievedOne) {
  FitMonitor monitor = tracking();
  const FitMonitor::Observation wrong{
      .passed_s = 0.2, .driven_m = 0.1, .fit = 0.3, .verdict = PoseVerdict::kWrong, .beaten = true};
  int scans = 0;
  while (monitor.observe(wrong, certain()) == LocalizerState::kTracking) ++scans;
  EXPECT_NEAR(0.2 * scans, 1.5, 0.3) << "s";
  EXPECT_EQ(monitor.state(), LocalizerState::kLost);
  EXPECT_EQ(monitor.observe(wrong, certain()), LocalizerState::kGlobal);
}

TEST(FitMonitor, TracksOnWhereLittleFitsButProvenTilesHoldThePose) {
  FitMonitor monitor = tracking();
  LocalizerState state{};
  for (int i = 0; i < 300; ++i) {
    state = monitor.observe({.passed_s = 0.2, .driven_m = 0.1, .fit = 0.2, .verdict = PoseVerdict::kRight}, certain());
  }
  EXPECT_EQ(state, LocalizerState::kTracking);
}

TEST(FitMonitor, IsLostWhereTheVerdictStaysWrongHoweverWellMostBeamsFit) {
  FitMonitor monitor = tracking();
  const FitMonitor::Observation wrong{
      .passed_s = 0.2, .driven_m = 0.1, .turned_rad = 0.0, .fit = 0.8, .verdict = PoseVerdict::kWrong};
  EXPECT_EQ(monitor.observe(wrong, certain()), LocalizerState::kTracking) << "one view is not enough";
  LocalizerState state{};
  for (int i = 0; i < 10; ++i) state = monitor.observe(wrong, certain());
  EXPECT_EQ(state, LocalizerState::kLost);
}

}  // namespace
}  // namespace deltamap::localization::belief
