// SPDX-License-Identifier: Apache-2.0
#include "drivers/port/reconnect.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace deltamap::drivers::port {
namespace {

constexpr Timestamp kNow = timestamp_from_ns(1'000'000'000'000);

TEST(Reconnect, PausesLongerFromTryToTryUpToTheCap) {
  Reconnect reconnect{{.first_pause_s = 0.5, .growth = 2.0, .longest_pause_s = 3.0}};
  std::vector<double> pauses_s;
  for (int i = 0; i < 5; ++i) pauses_s.push_back(seconds(reconnect.failed("gone", kNow).try_again_at - kNow));
  EXPECT_EQ(pauses_s, (std::vector<double>{0.5, 1.0, 2.0, 3.0, 3.0}));
}

TEST(Reconnect, TellsAReasonOnceAndANewReasonAgain) {
  Reconnect reconnect{{}};
  EXPECT_EQ(reconnect.failed("/dev/ttyUSB0 is missing", kNow).log, "/dev/ttyUSB0 is missing; trying again");
  EXPECT_FALSE(reconnect.failed("/dev/ttyUSB0 is missing", kNow).log);
  EXPECT_TRUE(reconnect.failed("/dev/ttyUSB0 is busy", kNow).log);
}

TEST(Reconnect, PausesShortlyAgainOnceThePortHasOpened) {
  Reconnect reconnect{{.first_pause_s = 0.5, .growth = 2.0, .longest_pause_s = 8.0}};
  for (int i = 0; i < 5; ++i) (void)reconnect.failed("missing", kNow);
  reconnect.opened();
  EXPECT_EQ(reconnect.failed("does not answer", kNow).try_again_at, kNow + duration_from_seconds(0.5));
}

TEST(Reconnect, StartsAfreshOnceTheDeviceWorks) {
  Reconnect reconnect{{.first_pause_s = 0.5}};
  EXPECT_FALSE(reconnect.connected());
  (void)reconnect.failed("gone", kNow);
  (void)reconnect.failed("gone", kNow);
  EXPECT_EQ(reconnect.connected(), "connected again after 2 failures");
  EXPECT_FALSE(reconnect.connected());
  const auto again = reconnect.failed("gone", kNow);
  EXPECT_TRUE(again.log);
  EXPECT_EQ(again.try_again_at, kNow + duration_from_seconds(0.5));
}

}  // namespace
}  // namespace deltamap::drivers::port
