// SPDX-License-Identifier: Apache-2.0
// One fault after another of lines, devices and people's hands: a short form of `./dev bench faults`.
#include <gtest/gtest.h>

#include "experiments/closed_loop/driver_trial.hpp"
#include "tests/support/worlds/quiet_room.hpp"

namespace deltamap {
namespace {

TEST(DriverTrials, DeliverAgainSoonAndNothingWrongBecomesDataOrMotion) {
  constexpr std::uint64_t kRuns = 20;
  const auto faults = experiments::driver_faults();
  double moved_m = 0.0;
  std::size_t tried = 0;
  for (std::uint64_t seed = 1; seed <= kRuns; ++seed) {
    const auto outcome = experiments::outcome_of({seed, 60.0, faults}, test::quiet_room(), {});
    for (const auto& fault : outcome.faults)
      EXPECT_TRUE(fault.is_back_soon) << "seed " << seed << ' ' << fault.order << " at " << fault.begins_s
                                      << " s: back after " << fault.back_after_s << " s";
    EXPECT_EQ(outcome.wrong_frames, 0) << "seed " << seed;
    EXPECT_EQ(outcome.wrong_scans, 0) << "seed " << seed;
    EXPECT_EQ(outcome.collisions, 0) << "seed " << seed;
    EXPECT_TRUE(outcome.forbidden.empty()) << "seed " << seed << ' ' << outcome.forbidden.front();
    moved_m += outcome.moved_m;
    tried += outcome.faults.size();
  }
  EXPECT_GT(moved_m, 1.0 * kRuns) << "a robot that stands proves nothing";
  EXPECT_GT(tried, 3 * kRuns);
}

TEST(DriverTrials, TellAnOperatorOfALineThatIsDisturbed) {
  for (const char* fault : {"robot-bit-flips", "laser-noise"}) {
    bool is_told = false;
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      for (const auto& tried : experiments::outcome_of({seed, 60.0, {fault}}, test::quiet_room(), {}).faults) {
        for (const std::string& line : tried.lines)
          is_told = is_told || line.find("line is disturbed") != std::string::npos;
      }
    }
    EXPECT_TRUE(is_told) << fault;
  }
}

}  // namespace
}  // namespace deltamap
