// SPDX-License-Identifier: Apache-2.0
#include "daemon/incidents/incident_watch.hpp"

#include <gtest/gtest.h>

namespace deltamap::daemon {
namespace {

using navigation::StopReason;

Timestamp at_s(double time_s) { return timestamp_from_ns(1'700'000'000'000'000'000) + duration_from_seconds(time_s); }

LocalizationRow row(double time_s, LocalizerState state) {
  LocalizationRow row;
  row.time = at_s(time_s);
  row.state = state;
  return row;
}

TEST(PoseWatch, TellsALossAndAKidnappingByTheStateThatEndsTracking) {
  PoseWatch watch;
  EXPECT_FALSE(watch.observe(row(0.0, LocalizerState::kGlobal)));
  EXPECT_FALSE(watch.observe(row(0.1, LocalizerState::kTracking)));
  const auto lost = watch.observe(row(0.2, LocalizerState::kLost));
  ASSERT_TRUE(lost);
  EXPECT_EQ(lost->kind, IncidentKind::kLost);
  EXPECT_EQ(lost->time, at_s(0.2));
  EXPECT_FALSE(watch.observe(row(0.3, LocalizerState::kGlobal))) << "it was lost before";
  EXPECT_FALSE(watch.observe(row(0.4, LocalizerState::kTracking)));
  const auto kidnapped = watch.observe(row(0.5, LocalizerState::kGlobal));
  ASSERT_TRUE(kidnapped);
  EXPECT_EQ(kidnapped->kind, IncidentKind::kKidnapped);
}

TEST(PoseWatch, APoseThatIsInDoubtAfterALongPauseWasNotCarriedAway) {
  PoseWatch watch;
  (void)watch.observe(row(0.0, LocalizerState::kTracking));
  const auto event = watch.observe(row(25.0, LocalizerState::kGlobal));
  ASSERT_TRUE(event);
  EXPECT_EQ(event->kind, IncidentKind::kLost);
  EXPECT_EQ(event->words, "the pose is in doubt after 25 s without a scan");
}

TEST(RunWatch, ADeviceThatWorkedAndIsSilentForASecondIsAFaultOnce) {
  Telemetry telemetry;
  RunWatch watch;
  EXPECT_TRUE(watch.observe(telemetry, at_s(0.0)).empty()) << "it has not been there yet";
  telemetry.laser_up.set(true);
  EXPECT_TRUE(watch.observe(telemetry, at_s(1.0)).empty());
  telemetry.laser_up.set(false);
  telemetry.laser_trouble.set("the device hung up");
  EXPECT_TRUE(watch.observe(telemetry, at_s(1.9)).empty()) << "it may change its line speed";
  const auto events = watch.observe(telemetry, at_s(2.1));
  ASSERT_EQ(events.size(), 1u);
  EXPECT_EQ(events[0].kind, IncidentKind::kDeviceFault);
  EXPECT_EQ(events[0].time, at_s(1.0)) << "when it was there last";
  EXPECT_EQ(events[0].words, "the laser has fallen silent: the device hung up");
  EXPECT_TRUE(watch.observe(telemetry, at_s(9.0)).empty());
}

TEST(RunWatch, AStopIsToldOnceWhoeverShowsIt) {
  Telemetry telemetry;
  RunWatch watch;
  const auto set = [](Gauge<std::uint8_t>& gauge, StopReason reason) { gauge.set(static_cast<std::uint8_t>(reason)); };
  set(telemetry.stop_reason, StopReason::kObstacle);
  EXPECT_TRUE(watch.observe(telemetry, at_s(0.0)).empty()) << "driving brings that with it";
  set(telemetry.stop_reason, StopReason::kBumper);
  set(telemetry.unfit, StopReason::kBumper);
  const auto events = watch.observe(telemetry, at_s(0.1));
  ASSERT_EQ(events.size(), 1u);
  EXPECT_EQ(events[0].kind, IncidentKind::kSafetyStop);
  EXPECT_TRUE(watch.observe(telemetry, at_s(0.2)).empty());
  set(telemetry.stop_reason, StopReason::kNone);
  set(telemetry.unfit, StopReason::kNone);
  EXPECT_TRUE(watch.observe(telemetry, at_s(0.3)).empty());
  set(telemetry.unfit, StopReason::kLaserFrozen);
  const auto fault = watch.observe(telemetry, at_s(0.4));
  ASSERT_EQ(fault.size(), 1u);
  EXPECT_EQ(fault[0].kind, IncidentKind::kDeviceFault);
}

TEST(RunWatch, ThreeRefusalsWithoutARevisionBetweenThemAreAStreak) {
  Telemetry telemetry;
  RunWatch watch;
  telemetry.newest_revision.set(5);
  telemetry.stale_refusals.set(7);
  EXPECT_TRUE(watch.observe(telemetry, at_s(0.0)).empty());
  telemetry.stale_refusals.set(9);
  EXPECT_TRUE(watch.observe(telemetry, at_s(1.0)).empty());
  telemetry.newest_revision.set(6);
  EXPECT_TRUE(watch.observe(telemetry, at_s(2.0)).empty());
  telemetry.stale_refusals.set(11);
  EXPECT_TRUE(watch.observe(telemetry, at_s(3.0)).empty());
  telemetry.stale_refusals.set(12);
  const auto events = watch.observe(telemetry, at_s(4.0));
  ASSERT_EQ(events.size(), 1u);
  EXPECT_EQ(events[0].kind, IncidentKind::kRefusals);
  telemetry.stale_refusals.set(20);
  EXPECT_TRUE(watch.observe(telemetry, at_s(5.0)).empty()) << "one streak, one event";
}

TEST(RunWatch, RefusalsThatFoundTheMapRightAreNoStreak) {
  Telemetry telemetry;
  RunWatch watch;
  EXPECT_TRUE(watch.observe(telemetry, at_s(0.0)).empty());
  telemetry.refused.set(9);
  EXPECT_TRUE(watch.observe(telemetry, at_s(1.0)).empty());
}

}  // namespace
}  // namespace deltamap::daemon
