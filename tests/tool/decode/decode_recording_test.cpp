// SPDX-License-Identifier: Apache-2.0
// `deltamap decode REC`, run in-process on recordings that are written here.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <sstream>

#include "drivers/lms200/command.hpp"
#include "drivers/lms200/measurement.hpp"
#include "drivers/pioneer/command.hpp"
#include "drivers/pioneer/extra_packets.hpp"
#include "drivers/pioneer/status.hpp"
#include "tests/support/bytes/written_recording.hpp"
#include "tests/support/files/tool_run.hpp"

namespace deltamap::tool {
namespace {

namespace lms = drivers::lms200;
namespace pioneer = drivers::pioneer;
using drivers::port::Direction;
using drivers::port::PortId;
using test::run_deltamap;
using test::WrittenRecording;

std::vector<nlohmann::json> lines_of(const std::string& output) {
  std::vector<nlohmann::json> lines;
  std::istringstream in{output};
  for (std::string line; std::getline(in, line);) lines.push_back(nlohmann::json::parse(line));
  return lines;
}

std::vector<std::string> names_in(const std::string& output) {
  std::vector<std::string> names;
  for (const auto& line : lines_of(output)) names.push_back(line["name"]);
  return names;
}

lms::Measurement three_words() {
  lms::Measurement measurement;
  measurement.unit_code = 1;
  measurement.words = {1000, 2000, 0x1FF7};
  return measurement;
}

TEST(DecodeRecording, NamesWhatBothDevicesSayAndHearWithPortDirectionAndTime) {
  WrittenRecording recording;
  recording.note(0.0, "session robot begins");
  recording.bytes(1.0, PortId::kRobot, Direction::kOut, pioneer::encoded_command({pioneer::CommandNumber::kVel, 100}));
  recording.bytes(1.5, PortId::kRobot, Direction::kIn, pioneer::encoded_sip({}));
  recording.bytes(2.0, PortId::kLaser, Direction::kIn, lms::encoded_measurement(three_words()));
  const auto run = run_deltamap({"decode", recording.closed(), "--json"});
  ASSERT_EQ(run.exit_code, 0) << run.errors;
  const auto lines = lines_of(run.output);
  ASSERT_EQ(lines.size(), 4u);
  EXPECT_EQ(names_in(run.output), (std::vector<std::string>{"note", "VEL", "SIP", "scan"}));
  EXPECT_EQ(lines[0]["fields"]["text"], "session robot begins");
  EXPECT_EQ(lines[1]["direction"], "out");
  EXPECT_EQ(lines[1]["fields"]["argument"], 100);
  EXPECT_EQ(lines[1]["time_ns"], unix_ns(WrittenRecording::at(1.0)));
  EXPECT_EQ(lines[3]["port"], "laser");
  EXPECT_LT(lines[3]["after_s"], 2.0) << "the first byte came before the last";
  EXPECT_GT(lines[3]["after_s"], 1.98);
}

TEST(DecodeRecording, PutsFramesTogetherThatWereCutIntoChunksInEachDirectionByItself) {
  WrittenRecording recording;
  const auto sip = pioneer::encoded_sip({});
  const auto vel = pioneer::encoded_command({pioneer::CommandNumber::kVel, 100});
  const auto half = [](const std::vector<std::uint8_t>& bytes) {
    return static_cast<std::ptrdiff_t>(bytes.size() / 2);
  };
  recording.bytes(1.00, PortId::kRobot, Direction::kIn, {sip.begin(), sip.begin() + half(sip)});
  recording.bytes(1.01, PortId::kRobot, Direction::kOut, {vel.begin(), vel.begin() + half(vel)});
  recording.bytes(1.02, PortId::kRobot, Direction::kIn, {sip.begin() + half(sip), sip.end()});
  recording.bytes(1.03, PortId::kRobot, Direction::kOut, {vel.begin() + half(vel), vel.end()});
  EXPECT_EQ(names_in(run_deltamap({"decode", recording.closed(), "--json"}).output),
            (std::vector<std::string>{"SIP", "VEL"}));
}

TEST(DecodeRecording, TellsRepliesFromCommandsOfTheSameNumberByTheirDirection) {
  WrittenRecording recording;
  const auto sync = pioneer::encoded_command({pioneer::CommandNumber::kPulse, {}});
  recording.bytes(1.0, PortId::kRobot, Direction::kOut, sync);
  recording.bytes(1.1, PortId::kRobot, Direction::kIn, sync);
  EXPECT_EQ(names_in(run_deltamap({"decode", recording.closed(), "--json"}).output),
            (std::vector<std::string>{"SYNC0 or PULSE", "SYNC0 echo"}));
}

TEST(DecodeRecording, ReadsRangesInTheModeThatTheLaserTells) {
  WrittenRecording recording;
  recording.bytes(1.0, PortId::kLaser, Direction::kIn, lms::encoded_measurement(three_words()));
  recording.bytes(1.1, PortId::kLaser, Direction::kIn, lms::configuration_reply({}));
  recording.bytes(1.2, PortId::kLaser, Direction::kIn, lms::encoded_measurement(three_words()));
  const auto lines = lines_of(run_deltamap({"decode", recording.closed(), "--kind", "scan", "--json"}).output);
  ASSERT_EQ(lines.size(), 2u);
  EXPECT_FALSE(lines[0]["fields"].contains("beams_m")) << "nobody has told its mode yet";
  EXPECT_EQ(lines[1]["fields"]["beams_m"], (nlohmann::json{"1.000", "2.000", "beyond maximum"}));
}

TEST(DecodeRecording, CountsTheGarbageAndSaysWhy) {
  WrittenRecording recording;
  auto broken = pioneer::encoded_sip({});
  broken.back() ^= 1;
  recording.bytes(1.0, PortId::kRobot, Direction::kIn, broken);
  const auto lines = lines_of(run_deltamap({"decode", recording.closed(), "--json"}).output);
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_EQ(lines[0]["name"], "garbage");
  EXPECT_EQ(lines[0]["bytes"], broken.size());
  EXPECT_EQ(lines[0]["fields"]["wrong_checksum"], 1);
}

TEST(DecodeRecording, KeepsToAWindowAndLearnsWhatWasToldBeforeIt) {
  WrittenRecording recording;
  recording.bytes(0.0, PortId::kLaser, Direction::kIn, lms::configuration_reply({}));
  for (const double at_s : {1.0, 2.0, 3.0}) {
    recording.bytes(at_s, PortId::kLaser, Direction::kIn, lms::encoded_measurement(three_words()));
  }
  const auto lines =
      lines_of(run_deltamap({"decode", recording.closed(), "--from", "1.5", "--to", "2.5", "--json"}).output);
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_TRUE(lines[0]["fields"].contains("beams_m"));
}

TEST(DecodeRecording, NamesTheKindsThatThereAreWhereNoneIsOfTheWantedOne) {
  WrittenRecording recording;
  recording.bytes(1.0, PortId::kRobot, Direction::kIn, pioneer::encoded_sip({}));
  const std::string file = recording.closed();
  const auto run = run_deltamap({"decode", file, "--kind", "SUP"});
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_EQ(run.errors,
            "deltamap: " + file + ": holds no 'SUP' in this window (nearest kind SIP); there are SIP (1)\n");
  EXPECT_EQ(run_deltamap({"decode", file, "--kind", "sip"}).exit_code, 0) << "capitals do not matter";
}

TEST(DecodeRecording, PrintsTextForPeople) {
  WrittenRecording recording;
  recording.bytes(0.0, PortId::kRobot, Direction::kOut, pioneer::encoded_command({pioneer::CommandNumber::kVel, -100}));
  recording.note(2.0, std::string(300, 'x'));
  EXPECT_EQ(run_deltamap({"decode", recording.closed()}).output,
            "0.000000 s  VEL  (robot, out, 9 bytes)\n  command: 11\n  argument: -100\n"
            "2.000000 s  note  (robot)\n  text: " +
                std::string(200, 'x') + "… (300 characters)\n");
}

TEST(DecodeRecording, RefusesBytesBesideARecording) {
  EXPECT_EQ(run_deltamap({"decode", "drive.pcapng", "00"}).exit_code, 2);
}

}  // namespace
}  // namespace deltamap::tool
