// SPDX-License-Identifier: Apache-2.0
#include "drivers/pioneer/farewell.hpp"

#include "tests/drivers/pioneer/part_fixture.hpp"

namespace deltamap::drivers::pioneer {
namespace {

class FarewellTest : public PartTest {
 protected:
  void begin(bool has_opened) {
    Transmitter to = line();
    farewell.begin(has_opened, to);
  }
  bool pushes_close() {
    Transmitter to = line();
    return farewell.pushes_close(to);
  }

  Farewell farewell;
};

TEST_F(FarewellTest, ClosesARobotThatStandsAtOnce) {
  begin(true);
  EXPECT_FALSE(pushes_close()) << "the stop goes first";
  EXPECT_EQ(sent(), kStop);
  EXPECT_FALSE(farewell.is_over(commands));
  EXPECT_TRUE(pushes_close());
  EXPECT_EQ(sent(), (std::vector<Command>{{CommandNumber::kClose, {}}}));
  EXPECT_TRUE(farewell.is_over(commands));
  EXPECT_FALSE(farewell.reason());
}

TEST_F(FarewellTest, WaitsUntilTheRobotStands) {
  Sip sip;
  sip.left_mm_per_s = 300;
  take(encoded_sip(sip));
  begin(true);
  EXPECT_NEAR(seconds(farewell.deadline() - now), 0.3 / 0.3 + 0.1, 1e-6) << "the deceleration as delivered";
  (void)sent();
  EXPECT_FALSE(pushes_close());
  now = farewell.deadline();
  EXPECT_TRUE(pushes_close());
}

TEST_F(FarewellTest, SendsNoCloseToARobotThatBrakesForLongOrWasNotOpened) {
  begin(false);
  EXPECT_EQ(sent(), kStop);
  EXPECT_TRUE(farewell.is_over(commands));
  Sip sip;
  sip.right_mm_per_s = -30000;
  take(encoded_sip(sip));
  begin(true);
  EXPECT_EQ(sent(), kStop);
  EXPECT_TRUE(farewell.is_over(commands));
  ASSERT_EQ(out.log.size(), 1u);
  EXPECT_TRUE(out.log[0].starts_with("robot is told to stop and not let go"));
}

TEST_F(FarewellTest, SendsNoCloseWhereTheLinkHasFailed) {
  begin(true);
  Transmitter to = line();
  farewell.begin_after_failure("gone", to);
  EXPECT_EQ(sent(), kStop);
  EXPECT_FALSE(pushes_close());
  EXPECT_TRUE(farewell.is_over(commands));
  EXPECT_EQ(farewell.reason(), "gone");
}

}  // namespace
}  // namespace deltamap::drivers::pioneer
