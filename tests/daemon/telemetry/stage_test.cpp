// SPDX-License-Identifier: Apache-2.0
#include "daemon/telemetry/stage.hpp"

#include <gtest/gtest.h>

#include <future>

namespace deltamap::daemon {
namespace {

TEST(Stage, TellsWhatItHasUsedWhileItRunsAndNothingAfterwards) {
  constexpr double kWork_s = 0.02;
  std::promise<double> worked;
  std::promise<void> may_end;
  Stage stage{{"worker", 0},
              [&] {
                while (thread_cpu_s() < kWork_s) {
                }
                worked.set_value(thread_cpu_s());
                may_end.get_future().wait();
              },
              [](const std::string& why) { FAIL() << why; }};
  const double used_s = worked.get_future().get();
  const auto now_s = stage.cpu_now_s();
  ASSERT_TRUE(now_s);
  EXPECT_GE(*now_s, used_s);
  EXPECT_LT(*now_s, used_s + kWork_s) << "it only waits since";
  may_end.set_value();
  stage.join();
  EXPECT_FALSE(stage.cpu_now_s());
  EXPECT_GE(stage.cpu_s(), used_s);
}

}  // namespace
}  // namespace deltamap::daemon
