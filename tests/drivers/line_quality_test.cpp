// SPDX-License-Identifier: Apache-2.0
#include "drivers/line_quality.hpp"

#include <gtest/gtest.h>

namespace deltamap::drivers {
namespace {

class LineQualityTest : public testing::Test {
 protected:
  /// The line that is told of a chunk so long after the one before; empty: none.
  std::string hear(double after_s, bool has_frame, bool has_damage) {
    now_ += duration_from_seconds(after_s);
    counts_.frames += has_frame ? 1 : 0;
    counts_.garbage_bytes += has_damage ? 7 : 0;
    const auto change = quality_.observe(counts_, now_);
    is_disturbed_ = change ? change->is_disturbed : is_disturbed_;
    return change ? change->line : "";
  }

  LineQuality quality_{Device::kLaser};
  DecoderCounts counts_;
  Timestamp now_ = timestamp_from_ns(1'700'000'000'000'000'000);
  bool is_disturbed_ = false;
};

TEST_F(LineQualityTest, TellsAnOperatorOnceThatTheLineIsDisturbedAndOnceThatItIsCleanAgain) {
  EXPECT_EQ(hear(0.1, true, false), "");
  EXPECT_EQ(hear(0.1, true, true), "");
  EXPECT_EQ(hear(0.1, true, true), "");
  EXPECT_EQ(hear(0.1, true, true),
            "laser line is disturbed: damaged three times within 5 s; look at its cable, plugs and adapter");
  for (int i = 0; i < 30; ++i) EXPECT_EQ(hear(0.1, true, true), "");
  for (int i = 0; i < 99; ++i) EXPECT_EQ(hear(0.1, true, false), "");
  EXPECT_TRUE(is_disturbed_);
  (void)hear(0.2, true, false);
  EXPECT_FALSE(is_disturbed_);
}

TEST_F(LineQualityTest, BearsWhatIsDamagedNowAndThen) {
  for (int i = 0; i < 200; ++i) EXPECT_EQ(hear(0.1, true, i % 40 == 0), "") << i;
}

TEST_F(LineQualityTest, CountsOneDamageHoweverManyChunksItComesIn) {
  EXPECT_EQ(hear(0.1, true, false), "");
  for (int i = 0; i < 50; ++i) EXPECT_EQ(hear(0.01, false, true), "") << i;
}

TEST_F(LineQualityTest, KnowsNothingOfWhatCameBeforeTheDeviceWorked) {
  counts_.garbage_bytes = 10'000;
  EXPECT_EQ(hear(0.1, true, false), "");
  (void)hear(0.1, true, true);
  (void)hear(0.1, true, true);
  quality_.forget();
  EXPECT_EQ(hear(0.1, true, true), "");
}

}  // namespace
}  // namespace deltamap::drivers
