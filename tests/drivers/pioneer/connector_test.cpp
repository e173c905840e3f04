// SPDX-License-Identifier: Apache-2.0
#include "drivers/pioneer/connector.hpp"

#include "tests/drivers/pioneer/part_fixture.hpp"

namespace deltamap::drivers::pioneer {
namespace {

using Result = Connector::Result;
using std::chrono::milliseconds;

const Command kSync0Command{static_cast<CommandNumber>(kSync0), {}};
const Command kSync1Command{static_cast<CommandNumber>(kSync1), {}};
const Command kSync2Command{static_cast<CommandNumber>(kSync2), {}};

class ConnectorTest : public PartTest {
 protected:
  void start() {
    Transmitter to = line();
    connector.start(to);
  }
  void time_out() {
    Transmitter to = line();
    connector.time_out(to);
  }
  void hear(const std::vector<std::uint8_t>& frame) {
    const Packet packet = take(frame);
    Transmitter to = line();
    connector.hear(packet, to);
  }
  void hear_echo(std::uint8_t type) { hear(encoded_packet(std::vector<std::uint8_t>{type})); }
  /// The robot is quiet: SYNC0 is due.
  void be_quiet() {
    now += milliseconds{150};
    time_out();
  }

  Connector connector{9600, 9600};
};

TEST_F(ConnectorTest, OpensARobotThatWaits) {
  start();
  EXPECT_EQ(sent(), kStop);
  be_quiet();
  EXPECT_EQ(sent(), std::vector<Command>{kSync0Command});
  hear_echo(kSync0);
  EXPECT_EQ(sent(), std::vector<Command>{kSync1Command});
  hear_echo(kSync1);
  EXPECT_EQ(sent(), std::vector<Command>{kSync2Command});
  EXPECT_FALSE(connector.has_opened());
  hear(encoded_identity({"mapper", "Pioneer", "p3dx-sh"}));
  EXPECT_EQ(sent(), (std::vector<Command>{{CommandNumber::kOpen, {}}}));
  EXPECT_TRUE(connector.has_opened());
  EXPECT_EQ(connector.result(), Result::kPending);
  hear(encoded_sip(Sip{}));
  EXPECT_EQ(connector.result(), Result::kConnected);
}

TEST_F(ConnectorTest, ClosesAConnectionThatWasLeftOverAfterASipYoungerThanTheStop) {
  start();
  (void)sent();
  hear(encoded_sip(Sip{}));
  EXPECT_TRUE(connector.waits_for_queue());
  hear(encoded_sip(Sip{}));  // the stop waits in the queue still
  EXPECT_EQ(sent(), kStop);
  now += milliseconds{100};
  hear(encoded_sip(Sip{}));
  EXPECT_EQ(sent(), (std::vector<Command>{{CommandNumber::kClose, {}}}));
  be_quiet();
  EXPECT_EQ(sent(), kStop) << "from the beginning";
}

TEST_F(ConnectorTest, GivesUpOnARobotThatDoesNotHeedClose) {
  start();
  int closed = 0;
  for (int i = 0; i < 100 && connector.result() == Result::kPending; ++i) {
    for (const Command& command : sent()) closed += command.number == CommandNumber::kClose ? 1 : 0;
    now += milliseconds{100};
    hear(encoded_sip(Sip{}));
    time_out();
  }
  EXPECT_EQ(connector.result(), Result::kStaysConnected);
  EXPECT_EQ(closed, 5);
}

TEST_F(ConnectorTest, TriesEverySpeedAndNamesThem) {
  start();
  const Timestamp begin = now;
  while (connector.result() == Result::kPending && now < begin + std::chrono::seconds{60}) {
    (void)sent();
    now += milliseconds{10};
    time_out();
  }
  EXPECT_EQ(connector.result(), Result::kNobodyAnswers);
  EXPECT_EQ(connector.tried_bauds(), "9600, 38400, 115200, 19200, 57600");
}

TEST_F(ConnectorTest, LeavesASpeedAtWhichOnlyGarbageComes) {
  start();
  (void)sent();
  be_quiet();
  (void)sent();
  const std::vector<std::uint8_t> garbage(40, 0x55);
  EXPECT_TRUE(receiver.decode(garbage, now).empty());
  connector.notice_another_speed(receiver, now);
  EXPECT_EQ(connector.deadline(), now);
  time_out();
  EXPECT_EQ(receiver.baud(), 38400u);
}

}  // namespace
}  // namespace deltamap::drivers::pioneer
