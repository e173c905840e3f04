// SPDX-License-Identifier: Apache-2.0
#include "daemon/system/stop_signals.hpp"

#include <gtest/gtest.h>

namespace deltamap::daemon {
namespace {

TEST(StopSignals, WhatWasIgnoredAtTheStartStaysIgnored) {
  for (const int signal : {SIGHUP, SIGINT, SIGQUIT}) {
    const auto before = std::signal(signal, SIG_IGN);
    const sigset_t while_ignored = stop_signals();
    (void)std::signal(signal, SIG_DFL);
    const sigset_t otherwise = stop_signals();
    (void)std::signal(signal, before);
    EXPECT_EQ(sigismember(&while_ignored, signal), 0) << signal;
    EXPECT_EQ(sigismember(&otherwise, signal), 1) << signal;
  }
}

TEST(StopSignals, ATerminationIsNeverIgnored) {
  const auto before = std::signal(SIGTERM, SIG_IGN);
  const sigset_t signals = stop_signals();
  (void)std::signal(SIGTERM, before);
  EXPECT_EQ(sigismember(&signals, SIGTERM), 1);
}

}  // namespace
}  // namespace deltamap::daemon
