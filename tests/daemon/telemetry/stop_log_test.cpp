// SPDX-License-Identifier: Apache-2.0
#include "daemon/telemetry/stop_log.hpp"

#include <gtest/gtest.h>

namespace deltamap::daemon {
namespace {

using navigation::StopReason;

TEST(StopLog, TellsOnceThatDrivingStopsAndOnceThatItGoesOn) {
  StopLog log;
  EXPECT_EQ(log.line(StopReason::kNone), LogLine{});
  EXPECT_EQ(log.line(StopReason::kBumper),
            (LogLine{"driving stops: bumper; waits until it is over and a person says drive", true}));
  for (int i = 0; i < 100; ++i) EXPECT_EQ(log.line(StopReason::kBumper), LogLine{});
  EXPECT_EQ(log.line(StopReason::kNone), LogLine{"driving goes on"});
  EXPECT_EQ(log.line(StopReason::kNone), LogLine{});
  EXPECT_EQ(log.line(StopReason::kLost), (LogLine{"driving stops: lost; until it is over", true}));
}

TEST(StopLog, TellsEachReasonThatFollowsAnother) {
  StopLog log;
  EXPECT_NE(log.line(StopReason::kLost), LogLine{});
  EXPECT_NE(log.line(StopReason::kLowBattery), LogLine{});
}

TEST(StopLog, IsNotStirredByWhatDrivingBringsWithIt) {
  StopLog log;
  for (const StopReason reason : {StopReason::kNoCommand, StopReason::kObstacle, StopReason::kCommandExpired,
                                  StopReason::kMotorsOff, StopReason::kStopButton, StopReason::kNone}) {
    EXPECT_EQ(log.line(reason), LogLine{}) << name_of(reason);
  }
  EXPECT_NE(log.line(StopReason::kPoseUnknown), LogLine{});
  EXPECT_EQ(log.line(StopReason::kCommandExpired), LogLine{});
  EXPECT_EQ(log.line(StopReason::kPoseUnknown), LogLine{}) << "still the same";
}

TEST(StopLog, TellsPlannersOnceThatTheyMustNotDriveAndOnceThatTheyMay) {
  StopLog log;
  EXPECT_EQ(log.line_for_planners(StopReason::kNone, StopReason::kNone), LogLine{});
  EXPECT_EQ(log.line_for_planners(StopReason::kLaserBlind, StopReason::kLost),
            (LogLine{"planners must not drive by the pose: laser sees nothing; until it is over", true}));
  EXPECT_EQ(log.line_for_planners(StopReason::kLaserBlind, StopReason::kNone), LogLine{});
  EXPECT_EQ(log.line_for_planners(StopReason::kNone, StopReason::kLost),
            (LogLine{"planners must not drive by the pose: lost; until it is over"}));
  EXPECT_EQ(log.line_for_planners(StopReason::kStaleLaser, StopReason::kLost), LogLine{}) << "the port's line tells";
  EXPECT_EQ(log.line_for_planners(StopReason::kNone, StopReason::kNone),
            LogLine{"planners may drive by the pose again"});
  EXPECT_EQ(log.line_for_planners(StopReason::kNone, StopReason::kNone), LogLine{});
}

}  // namespace
}  // namespace deltamap::daemon
