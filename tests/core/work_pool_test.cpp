// SPDX-License-Identifier: Apache-2.0
#include "core/work_pool.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>
#include <vector>

namespace deltamap {
namespace {

TEST(WorkPool, DoesEachPieceOnceAndTellsOfEach) {
  std::vector<std::atomic<int>> times(100);
  std::vector<int> told(100);
  work_through(
      100, 4, [&](std::size_t i) { ++times[i]; }, [&](std::size_t i) { ++told[i]; });
  for (const auto& one : times) EXPECT_EQ(one, 1);
  EXPECT_EQ(told, std::vector<int>(100, 1));
}

TEST(WorkPool, ThrowsOnWhatAPieceThrowsAndBeginsNoMore) {
  std::atomic<int> begun{0};
  const auto work = [&](std::size_t i) {
    ++begun;
    if (i == 3) throw std::runtime_error("three");
  };
  EXPECT_THROW(work_through(1000, 1, work, [](std::size_t) {}), std::runtime_error);
  EXPECT_EQ(begun, 4);
}

}  // namespace
}  // namespace deltamap
