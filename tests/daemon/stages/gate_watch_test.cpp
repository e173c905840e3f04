// SPDX-License-Identifier: Apache-2.0
#include "daemon/stages/gate_watch.hpp"

#include <gtest/gtest.h>

namespace deltamap::daemon {
namespace {

mapping::Awareness shut(double for_s) {
  mapping::Awareness awareness;
  awareness.gate = mapping::gate::GateReason::kOtherHypothesis;
  awareness.gate_shut_for_s = for_s;
  return awareness;
}

TEST(GateWatch, SpeaksOnceAfterAMinuteAndWhenItIsOpenAgain) {
  GateWatch watch;
  EXPECT_EQ(watch.observe({}), LogLine{});
  EXPECT_EQ(watch.observe(shut(59.0)), LogLine{});
  EXPECT_EQ(watch.observe(shut(60.0)), (LogLine{"map is not written: the gate is closed for 60 s reason=rival", true}));
  EXPECT_EQ(watch.observe(shut(90.0)), LogLine{});
  EXPECT_EQ(watch.observe({}), LogLine{"map is written again: the gate was closed for 90 s"});
  EXPECT_EQ(watch.observe({}), LogLine{});
}

TEST(GateWatch, KeepsSilentAboutMoments) {
  GateWatch watch;
  for (int i = 0; i < 100; ++i) {
    EXPECT_EQ(watch.observe(shut(2.0)), LogLine{});
    EXPECT_EQ(watch.observe({}), LogLine{});
  }
}

}  // namespace
}  // namespace deltamap::daemon
