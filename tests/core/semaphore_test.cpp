// SPDX-License-Identifier: Apache-2.0
#include "core/semaphore.hpp"

#include <gtest/gtest.h>

#include <thread>

namespace deltamap {
namespace {

using namespace std::chrono_literals;

TEST(Semaphore, LetsAsManyThroughAsItWasReleased) {
  Semaphore semaphore;
  EXPECT_FALSE(semaphore.try_acquire());
  semaphore.release();
  semaphore.release();
  EXPECT_TRUE(semaphore.try_acquire_for(0s));
  EXPECT_TRUE(semaphore.try_acquire());
  EXPECT_FALSE(semaphore.try_acquire());
}

TEST(Semaphore, WaitsSoLongAndNoLonger) {
  Semaphore semaphore;
  const auto begin = std::chrono::steady_clock::now();
  EXPECT_FALSE(semaphore.try_acquire_for(20ms));
  EXPECT_GE(std::chrono::steady_clock::now() - begin, 20ms);
}

TEST(Semaphore, WakesWhoeverWaits) {
  Semaphore semaphore;
  std::thread releases{[&] {
    std::this_thread::sleep_for(5ms);
    semaphore.release();
  }};
  EXPECT_TRUE(semaphore.try_acquire_for(60s));
  releases.join();
}

}  // namespace
}  // namespace deltamap
