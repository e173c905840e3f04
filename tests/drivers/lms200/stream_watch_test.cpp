// SPDX-License-Identifier: Apache-2.0
// The watch over a stream alone, with single telegrams.
#include "drivers/lms200/stream_watch.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "drivers/lms200/command.hpp"
#include "drivers/lms200/measurement.hpp"

namespace deltamap::drivers::lms200 {
namespace {

using Bytes = std::vector<std::uint8_t>;
using State = StreamWatch::State;
using std::chrono::milliseconds;

class StreamWatchTest : public testing::Test {
 protected:
  void SetUp() override {
    watch.start(now);
    hear(status_reply(agreed()));
    hear(configuration_reply(Configuration{}));
    Transmitter line{receiver, now, out};
    watch.begin_stream(line);
    ASSERT_EQ(watch.state(), State::kStreaming);
  }

  [[nodiscard]] static DeviceStatus agreed() {
    DeviceStatus status;
    status.operating_mode = mode::kStreamAll;
    status.resolution_centideg = 50;
    status.units = 1;
    return status;
  }
  [[nodiscard]] static Bytes scan() {
    Measurement measurement;
    measurement.words.assign(361, 1500);
    measurement.unit_code = 1;
    return encoded_measurement(measurement);
  }

  void hear(const Bytes& bytes) {
    Transmitter line{receiver, now, out};
    for (const Telegram& telegram : receiver.decode(bytes, now).telegrams) {
      (void)receiver.take(telegram);
      if (watch.state() != State::kIdle) watch.answer(telegram, line);
    }
  }
  void time_out() {
    now = watch.deadline();
    Transmitter line{receiver, now, out};
    watch.time_out(line);
  }
  void fall_silent() {
    time_out();
    ASSERT_EQ(watch.state(), State::kFellSilent);
    Transmitter line{receiver, now, out};
    watch.begin_visits(line);
  }
  [[nodiscard]] bool has_asked() const {
    return !out.requests.empty() && out.requests.back().bytes == status_request();
  }

  Lms200Params params;
  Receiver receiver{params, SessionMode::kLive};
  StreamWatch watch{params};
  Timestamp now = timestamp_from_ns(1'700'000'000'000'000'000);
  SessionOutput out;
};

TEST_F(StreamWatchTest, StaysWithAStreamAsLongAsScansCome) {
  for (int i = 0; i < 20; ++i) {
    now += milliseconds{213};
    hear(scan());
    EXPECT_GT(watch.deadline(), now + milliseconds{213});
  }
  EXPECT_EQ(watch.state(), State::kStreaming);
  EXPECT_TRUE(out.requests.empty());
  fall_silent();
  EXPECT_TRUE(has_asked());
}

TEST_F(StreamWatchTest, ResumesAtAScanAndAsksWhetherItIsAsAgreed) {
  fall_silent();
  out.requests.clear();
  hear(scan());
  EXPECT_EQ(watch.state(), State::kStreaming);
  EXPECT_TRUE(has_asked());
  DeviceStatus other = agreed();
  other.resolution_centideg = 100;
  hear(status_reply(other));
  EXPECT_EQ(watch.state(), State::kMustBeSetUp);
}

TEST_F(StreamWatchTest, ResumesAtAStatusAsAgreedWithoutAnotherQuestion) {
  fall_silent();
  out.requests.clear();
  hear(status_reply(agreed()));
  EXPECT_EQ(watch.state(), State::kStreaming);
  EXPECT_TRUE(out.requests.empty());
}

TEST_F(StreamWatchTest, HandsALaserThatDoesNotStreamToTheSetup) {
  fall_silent();
  DeviceStatus waiting = agreed();
  waiting.operating_mode = mode::kOnRequest;
  hear(status_reply(waiting));
  EXPECT_EQ(watch.state(), State::kMustBeSetUp);
}

TEST_F(StreamWatchTest, NoticesALaserThatSpeaksButDoesNotTellItsStatus) {
  fall_silent();
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(watch.state(), State::kVisiting);
    hear(refused_reply());
    time_out();
  }
  EXPECT_EQ(watch.state(), State::kDoesNotHear);
}

TEST_F(StreamWatchTest, EndsAVisitSoonAfterGarbageAndLooksWhereALaserStartsUp) {
  fall_silent();
  now += milliseconds{10};
  watch.take_no_telegram(true, now);
  EXPECT_EQ(watch.deadline(), now + milliseconds{80});
  time_out();
  EXPECT_EQ(receiver.baud(), 9600u);
}

TEST_F(StreamWatchTest, GivesUpOnceTheLaserCannotBeStartingUpAnyMore) {
  hear(scan());
  fall_silent();
  const Timestamp begin = now;
  while (watch.state() == State::kVisiting && now < begin + std::chrono::seconds{100}) time_out();
  EXPECT_EQ(watch.state(), State::kGivenUp);
  EXPECT_NEAR(seconds(now - begin), params.power_on_wait_s, 1.0);
  EXPECT_EQ(std::count(out.log.begin(), out.log.end(), "laser has sent no scan for 2000 ms"), 1);
}

}  // namespace
}  // namespace deltamap::drivers::lms200
