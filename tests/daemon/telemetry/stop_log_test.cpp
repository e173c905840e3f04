// SPDX-License-Identifier: Apache-2.0
#include "daemon/telemetry/stop_log.hpp"

#include <gtest/gtest.h>

namespace deltamap::daemon {
namespace {

using navigation::StopReason;

TEST(StopLog, TellsOnceThatDrivingStopsAndOnceThatItGoesOn) {
  StopLog log;
  EXPECT_EQ(log.line(StopReason::kNone), std::nullopt);
  EXPECT_EQ(log.line(StopReason::kBumper), "driving stops: bumper; waits until it is over and a person says drive");
  for (int i = 0; i < 100; ++i) EXPECT_EQ(log.line(StopReason::kBumper), std::nullopt);
  EXPECT_EQ(log.line(StopReason::kNone), "driving goes on");
  EXPECT_EQ(log.line(StopReason::kNone), std::nullopt);
  EXPECT_EQ(log.line(StopReason::kLost), "driving stops: lost; until it is over");
}

TEST(StopLog, TellsEachReasonThatFollowsAnother) {
  StopLog log;
  EXPECT_TRUE(log.line(StopReason::kLost).has_value());
  EXPECT_TRUE(log.line(StopReason::kLowBattery).has_value());
}

TEST(StopLog, IsNotStirredByWhatDrivingBringsWithIt) {
  StopLog log;
  for (const StopReason reason : {StopReason::kNoCommand, StopReason::kObstacle, StopReason::kCommandExpired,
                                  StopReason::kMotorsOff, StopReason::kStopButton, StopReason::kNone}) {
    EXPECT_EQ(log.line(reason), std::nullopt) << name_of(reason);
  }
  EXPECT_TRUE(log.line(StopReason::kPoseUnknown).has_value());
  EXPECT_EQ(log.line(StopReason::kCommandExpired), std::nullopt);
  EXPECT_EQ(log.line(StopReason::kPoseUnknown), std::nullopt) << "still the same";
}

}  // namespace
}  // namespace deltamap::daemon
