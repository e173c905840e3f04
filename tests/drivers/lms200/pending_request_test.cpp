// SPDX-License-Identifier: Apache-2.0
#include "drivers/lms200/pending_request.hpp"

#include <gtest/gtest.h>

#include "drivers/lms200/command.hpp"

namespace deltamap::drivers::lms200 {
namespace {

using std::chrono::milliseconds;

class PendingRequestTest : public testing::Test {
 protected:
  [[nodiscard]] Transmitter line() { return {receiver, now, out}; }
  void begin(const Request& request) {
    Transmitter to = line();
    pending.begin(request, to);
  }
  void send_again(const Request& request) {
    Transmitter to = line();
    pending.send_again(request, to);
  }

  const Request question{status_request(), 0.4, 3};
  Receiver receiver{Lms200Params{.baud = 9600}, SessionMode::kLive};
  Timestamp now = timestamp_from_ns(1'700'000'000'000'000'000);
  SessionOutput out;
  PendingRequest pending;
};

TEST_F(PendingRequestTest, IsOverdueOnceItIsOutAndItsTimeIsOver) {
  begin(question);
  ASSERT_EQ(out.requests.size(), 1u);
  EXPECT_EQ(out.requests[0].bytes, status_request());
  EXPECT_EQ(pending.deadline(), now + line_time(status_request().size(), 9600) + milliseconds{400});
}

TEST_F(PendingRequestTest, IsAskedAsOftenAsItsTriesAllow) {
  begin(question);
  EXPECT_TRUE(pending.may_be_sent_again());
  send_again(question);
  EXPECT_TRUE(pending.may_be_sent_again());
  send_again(question);
  EXPECT_FALSE(pending.may_be_sent_again());
  EXPECT_EQ(out.requests.size(), 3u);
  begin(question);
  EXPECT_TRUE(pending.may_be_sent_again()) << "another question";
}

TEST_F(PendingRequestTest, DoesNotCountAsATryWhatGotANakBeforeTheTenNaksAreUp) {
  const Request once{status_request(), 0.4, 1};
  begin(once);
  for (int naks = 1; naks <= 10; ++naks) {
    pending.hear_nak(now);
    EXPECT_EQ(pending.deadline(), now + milliseconds{40}) << "at least 30 ms, B1";
    ASSERT_TRUE(pending.may_be_sent_again()) << naks;
    send_again(once);
  }
  EXPECT_FALSE(pending.may_be_sent_again()) << "no NAK since";
  pending.hear_nak(now);
  EXPECT_FALSE(pending.may_be_sent_again());
}

TEST_F(PendingRequestTest, NeverWaitsLongerForANak) {
  begin(question);
  now = pending.deadline() - milliseconds{5};
  pending.hear_nak(now);
  EXPECT_EQ(pending.deadline(), now + milliseconds{5});
}

TEST_F(PendingRequestTest, WritesNothingInAPauseAndHearsNoNakInIt) {
  begin({{}, 0.45, 1});
  EXPECT_TRUE(out.requests.empty());
  pending.hear_nak(now);
  EXPECT_EQ(pending.deadline(), now + milliseconds{450});
  EXPECT_FALSE(pending.may_be_sent_again());
}

TEST_F(PendingRequestTest, IsAskedAgainSoonerWhereNoAckCameEither) {
  const Request patient{status_request(), 1.5, 4, 0.4};
  const Duration on_the_line = line_time(status_request().size(), 9600);
  begin(patient);
  EXPECT_EQ(pending.deadline(), now + on_the_line + milliseconds{400});
  pending.hear_ack();
  EXPECT_EQ(pending.deadline(), now + on_the_line + milliseconds{1500});
  send_again(patient);
  EXPECT_EQ(pending.deadline(), now + on_the_line + milliseconds{400}) << "of this one no ACK has come";
}

}  // namespace
}  // namespace deltamap::drivers::lms200
