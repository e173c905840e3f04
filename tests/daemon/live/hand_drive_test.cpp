// SPDX-License-Identifier: Apache-2.0
// One person who drives by the page, in a clock of the test's own.
#include "daemon/live/hand_drive.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <vector>

namespace deltamap::daemon {
namespace {

using Json = nlohmann::json;

class HandDriveTest : public testing::Test {
 protected:
  void begin() {
    drive_.emplace(7, hand_, telemetry_, [this] { return now_; });
  }
  void begin_and_take() {
    begin();
    telemetry_.by_hand.set(true);
    answer_({7, true, "driven"});
    EXPECT_EQ(heard()["type"], "taken");
  }
  /// The next message; null where there is none.
  Json heard() {
    const auto message = drive_->next();
    return message ? Json::parse(*message->bytes) : Json{};
  }
  void say(std::uint64_t beat, double speed_m_per_s) {
    drive_->hear(Json{{"beat", beat}, {"speed_m_per_s", speed_m_per_s}, {"turn_rate_rad_per_s", 0.5}}.dump());
  }
  void pass(double time_s) {
    now_ = now_ + std::chrono::duration_cast<Duration>(std::chrono::duration<double>(time_s));
  }

  Timestamp now_ = timestamp_from_ns(1'000'000'000'000);
  Telemetry telemetry_;
  std::function<void(const control::CommandOutcome&)> answer_;
  std::vector<DriveCommand> commands_;
  std::vector<std::uint64_t> let_go_;
  Hand hand_{.take = [this](std::uint64_t, auto answer) { answer_ = std::move(answer); },
             .drive =
                 [this](std::uint64_t who, const DriveCommand& command) {
                   EXPECT_EQ(who, 7u);
                   commands_.push_back(command);
                 },
             .let_go = [this](std::uint64_t who) { let_go_.push_back(who); }};
  std::optional<HandDrive> drive_;
};

TEST_F(HandDriveTest, NothingMovesBeforeTheRobotIsTaken) {
  begin();
  EXPECT_TRUE(heard().is_null());
  say(0, 0.3);
  EXPECT_TRUE(commands_.empty());
}

TEST_F(HandDriveTest, ARefusalIsToldAndEndsIt) {
  begin();
  answer_({7, false, "the STOP button is pressed: let it go first"});
  const Json told = heard();
  EXPECT_EQ(told["type"], "refused");
  EXPECT_EQ(told["why"], "the STOP button is pressed: let it go first");
  EXPECT_TRUE(drive_->is_over());
  EXPECT_TRUE(heard().is_null());
}

TEST_F(HandDriveTest, ACommandCountsFromTheBeatThatItAnswersHoweverLateItComes) {
  begin_and_take();
  const Timestamp sent = now_;
  EXPECT_EQ(heard(), (Json{{"type", "beat"}, {"number", 0}}));
  pass(0.2);
  say(0, 0.25);
  ASSERT_EQ(commands_.size(), 1u);
  EXPECT_EQ(commands_[0].time, sent);
  EXPECT_EQ(commands_[0].speed_m_per_s, 0.25);
  EXPECT_EQ(commands_[0].turn_rate_rad_per_s, 0.5);
}

TEST_F(HandDriveTest, BeatsComeTenTimesASecond) {
  begin_and_take();
  int beats = 0;
  for (int i = 0; i < 100; ++i, pass(0.01)) {
    if (heard()["type"] == "beat") say(static_cast<std::uint64_t>(beats++), 0.0);
  }
  EXPECT_NEAR(beats, 11, 1);
}

TEST_F(HandDriveTest, AnswersToBeatsThatWereNeverOrLongAgoSentAreNotObeyed) {
  begin_and_take();
  for (int i = 0; i < 20; ++i, pass(0.1)) {
    (void)heard();
    say(static_cast<std::uint64_t>(i), 0.0);
  }
  commands_.clear();
  say(20, 0.3);
  say(11, 0.3);
  say(~std::uint64_t{0}, 0.3);
  EXPECT_TRUE(commands_.empty());
  say(19, 0.3);
  EXPECT_EQ(commands_.size(), 1u);
}

TEST_F(HandDriveTest, AFloodEndsIt) {
  begin_and_take();
  (void)heard();
  for (int i = 0; i < 1000; ++i) say(0, 0.1);
  EXPECT_LT(commands_.size(), 50u);
  EXPECT_EQ(heard()["why"], "too many messages");
  EXPECT_EQ(let_go_, std::vector<std::uint64_t>{7});
}

TEST_F(HandDriveTest, SilenceEndsIt) {
  begin_and_take();
  (void)heard();
  pass(1.1);
  EXPECT_EQ(heard()["type"], "ended");
  EXPECT_EQ(let_go_, std::vector<std::uint64_t>{7});
  say(0, 0.3);
  EXPECT_TRUE(commands_.empty());
}

TEST_F(HandDriveTest, WhereSomebodySaysStopItEnds) {
  begin_and_take();
  telemetry_.by_hand.set(false);
  EXPECT_EQ(heard()["why"], "driving was switched off");
  EXPECT_TRUE(drive_->is_over());
}

TEST_F(HandDriveTest, WhatIsNoAnswerEndsIt) {
  for (const char* bad :
       {"", "x", "[]", "{}", "null", R"({"beat":0})", R"({"beat":-1,"speed_m_per_s":0,"turn_rate_rad_per_s":0})",
        R"({"beat":0,"speed_m_per_s":"1","turn_rate_rad_per_s":0})",
        R"({"beat":0.5,"speed_m_per_s":0,"turn_rate_rad_per_s":0})",
        R"({"beat":0,"speed_m_per_s":1e999,"turn_rate_rad_per_s":0})",
        R"({"beat":0,"speed_m_per_s":null,"turn_rate_rad_per_s":0})",
        "{\"beat\":0,\"speed_m_per_s\":0,\"turn_rate_rad_per_s\":\xFF}"}) {
    telemetry_.by_hand.set(false);
    begin_and_take();
    (void)heard();
    let_go_.clear();
    drive_->hear(bad);
    EXPECT_TRUE(drive_->is_over()) << bad;
    EXPECT_FALSE(let_go_.empty()) << bad;
    EXPECT_EQ(heard()["type"], "refused") << bad;
  }
  EXPECT_TRUE(commands_.empty());
}

TEST_F(HandDriveTest, WhoeverGoesLetsGo) {
  begin_and_take();
  drive_.reset();
  EXPECT_EQ(let_go_, std::vector<std::uint64_t>{7});
  begin();
  drive_.reset();
  EXPECT_EQ(let_go_.size(), 2u) << "the answer may still be on its way";
  answer_({7, true, "driven"});
}

}  // namespace
}  // namespace deltamap::daemon
