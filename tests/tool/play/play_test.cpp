// SPDX-License-Identifier: Apache-2.0
// The devices of a recording, played to a client: what is sent when, and how the client's words are held against the
// recorded ones.
#include <gtest/gtest.h>

#include "drivers/pioneer/command.hpp"
#include "drivers/pioneer/status.hpp"
#include "tests/support/files/tool_run.hpp"
#include "tool/play/heard_frames.hpp"
#include "tool/play/played_port.hpp"

namespace deltamap::tool {
namespace {

namespace pioneer = drivers::pioneer;
using drivers::port::ByteRecord;
using drivers::port::Direction;
using drivers::port::PortId;
using pioneer::CommandNumber;
using Bytes = std::vector<std::uint8_t>;

constexpr unsigned kBaud = 9600;

Bytes command(CommandNumber number, int argument) { return pioneer::encoded_command({number, argument}); }

ByteRecord record(Direction direction, const Bytes& bytes) { return {PortId::kRobot, direction, {}, bytes, {}, kBaud}; }

TEST(PlayedPort, SaysWhatTheDeviceSaidWhenItSaidIt) {
  PlayedPort port;
  port.add(record(Direction::kIn, {1, 2}), 1.0);
  port.add(record(Direction::kIn, {3}), 1.2);
  EXPECT_EQ(port.due(0.9), Bytes{});
  EXPECT_EQ(port.next_s(), 1.0);
  EXPECT_EQ(port.due(1.1), (Bytes{1, 2}));
  EXPECT_EQ(port.due(5.0), (Bytes{3}));
  EXPECT_FALSE(port.next_s());
}

TEST(PlayedPort, AnswersNotBeforeTheQuestionButDoesNotWaitForEver) {
  PlayedPort port;
  port.add(record(Direction::kOut, {7, 7, 7}), 0.5);
  port.add(record(Direction::kIn, {1}), 0.6);
  port.add(record(Direction::kIn, {2}), 0.7);
  EXPECT_EQ(port.due(0.65), Bytes{}) << "nobody has asked";
  port.hear(2);
  EXPECT_EQ(port.due(0.66), Bytes{}) << "nor whole";
  port.hear(1);
  EXPECT_EQ(port.due(0.66), (Bytes{1}));
  EXPECT_EQ(port.due(0.7), (Bytes{2}));
  PlayedPort unasked;
  unasked.add(record(Direction::kOut, {7}), 0.5);
  unasked.add(record(Direction::kIn, {1}), 0.6);
  unasked.add(record(Direction::kIn, {2}), 0.7);
  EXPECT_EQ(unasked.due(0.59 + PlayedPort::kPatienceS), Bytes{});
  EXPECT_EQ(unasked.due(0.6 + PlayedPort::kPatienceS), (Bytes{1, 2})) << "the rest catches up";
}

/// What a client says after VEL 100, SONAR 0 and VEL 200 were recorded.
std::vector<std::string> differences_of(const std::vector<Bytes>& said, HeardFrames& heard) {
  for (const Bytes& bytes :
       {command(CommandNumber::kVel, 100), command(CommandNumber::kSonar, 0), command(CommandNumber::kVel, 200)}) {
    heard.expect(record(Direction::kOut, bytes));
  }
  heard.expect(record(Direction::kIn, pioneer::encoded_sip({})));
  std::vector<std::string> lines;
  double after_s = 1.0;
  for (const Bytes& bytes : said) {
    const auto more = heard.hear(bytes, timestamp_from_ns(0) + duration_from_seconds(after_s), kBaud, after_s);
    lines.insert(lines.end(), more.begin(), more.end());
    after_s += 0.1;
  }
  return lines;
}

TEST(HeardFrames, SayNothingOfAClientThatSaysTheSame) {
  HeardFrames heard{PortId::kRobot};
  const Bytes vel = command(CommandNumber::kVel, 100);
  const auto lines = differences_of({{vel.begin(), vel.begin() + 4},
                                     {vel.begin() + 4, vel.end()},
                                     command(CommandNumber::kSonar, 0),
                                     command(CommandNumber::kVel, 200)},
                                    heard);
  EXPECT_EQ(lines, std::vector<std::string>{});
  EXPECT_EQ(heard.same(), 3u);
  EXPECT_EQ(heard.left(), 0u);
}

TEST(HeardFrames, NameWhatIsOtherLeftOutOrNew) {
  HeardFrames other{PortId::kRobot};
  EXPECT_EQ(differences_of({command(CommandNumber::kVel, 120)}, other),
            std::vector<std::string>{"after 1.000 s robot hears VEL 120 in place of VEL 100"});
  HeardFrames shorter{PortId::kRobot};
  EXPECT_EQ(differences_of({command(CommandNumber::kVel, 200)}, shorter),
            std::vector<std::string>{"after 1.000 s robot hears VEL 200; left out before it: VEL 100 and 1 more"});
  EXPECT_EQ(shorter.same(), 1u);
  HeardFrames added{PortId::kRobot};
  EXPECT_EQ(
      differences_of({command(CommandNumber::kEstall, 1)}, added),
      std::vector<std::string>{"after 1.000 s robot hears ESTALL 1; not recorded here, where VEL 100 comes next"});
  EXPECT_EQ(added.left(), 3u);
}

TEST(HeardFrames, CountBytesThatAreNoFrame) {
  HeardFrames heard{PortId::kRobot};
  EXPECT_EQ(differences_of({{0x55, 0x55}}, heard),
            std::vector<std::string>{"after 1.000 s robot hears 2 bytes that are no frame"});
  EXPECT_EQ(heard.differences(), 1u);
}

TEST(Replay, WantsMapAndFolderUnlessItPlaysTheDevices) {
  EXPECT_EQ(test::run_deltamap({"replay", "drive.pcapng", "--out", "out"}).exit_code, 2);
  EXPECT_EQ(test::run_deltamap({"replay", "drive.pcapng", "--map", "map.yaml"}).exit_code, 2);
  EXPECT_EQ(test::run_deltamap({"replay", "/nowhere.pcapng", "--to-pty", "ports"}).exit_code, 1);
}

TEST(Replay, RefusesWhatPlayingTheDevicesDoesNotHeed) {
  for (const std::vector<std::string>& unheeded : {std::vector<std::string>{"--map", "m.yaml"},
                                                   {"--out", "out"},
                                                   {"--config", "c.yaml"},
                                                   {"--seed", "1"},
                                                   {"--initial-pose", "0,0,0"},
                                                   {"--map-delay", "1"},
                                                   {"--set", "seed=1"},
                                                   {"--json"}}) {
    std::vector<std::string> words{"replay", "/nowhere.pcapng", "--to-pty", "ports"};
    words.insert(words.end(), unheeded.begin(), unheeded.end());
    const auto run = test::run_deltamap(words);
    EXPECT_EQ(run.exit_code, 2) << unheeded.front();
    EXPECT_NE(run.errors.find(unheeded.front()), std::string::npos) << run.errors;
  }
}

}  // namespace
}  // namespace deltamap::tool
