// SPDX-License-Identifier: Apache-2.0
// `deltamap decode`, run in-process.
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "drivers/lms200/command.hpp"
#include "drivers/lms200/value_selection.hpp"
#include "tests/support/bytes/golden_vectors.hpp"
#include "tests/support/bytes/hex.hpp"
#include "tool/decode/decoded_frame.hpp"
#include "tool/run_tool.hpp"

namespace deltamap::tool {
namespace {

using tests::bytes_from_hex;

struct Outcome {
  int exit_code = 0;
  std::string printed;
  std::string complained;
};

Outcome run(std::vector<const char*> arguments) {
  arguments.insert(arguments.begin(), {"deltamap", "decode"});
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  Outcome outcome;
  outcome.exit_code = run_tool(static_cast<int>(arguments.size()), arguments.data());
  outcome.printed = testing::internal::GetCapturedStdout();
  outcome.complained = testing::internal::GetCapturedStderr();
  return outcome;
}

std::vector<std::string> names_of(const DecodedStream& stream) {
  std::vector<std::string> names;
  for (const DecodedFrame& frame : stream.frames) names.push_back(frame.name);
  return names;
}

TEST(Decode, NamesEveryFrameOfTheRobotAndTheGarbageBetween) {
  const Outcome outcome = run({"robot", "574d53320d", "fafb03000000", "00", "fafb060b3bc800d33b", "--json"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.complained;
  const auto report = nlohmann::json::parse(outcome.printed);
  ASSERT_EQ(report["frames"].size(), 2u);
  EXPECT_EQ(report["frames"][0]["name"], "SYNC0 or PULSE");
  EXPECT_EQ(report["frames"][0]["at"], 5);
  EXPECT_EQ(report["frames"][1]["name"], "VEL");
  EXPECT_EQ(report["frames"][1]["fields"]["argument"], 200);
  ASSERT_EQ(report["garbage"].size(), 2u);
  EXPECT_EQ(report["garbage"][0]["hex"], "574d53320d");
  EXPECT_EQ(report["garbage"][1]["at"], 11);
}

TEST(Decode, TellsCommandsFromRepliesWithTheSameNumber) {
  EXPECT_EQ(names_of(decoded_robot_stream(bytes_from_hex("fafb06323b0000323b"))), std::vector<std::string>{"HOSTBAUD"});
  const auto sip = decoded_robot_stream(
      bytes_from_hex("fafb22320000000000000000000080000000001f000000000000ffff8000000000000051ff"));
  EXPECT_EQ(names_of(sip), std::vector<std::string>{"SIP"});
  EXPECT_EQ(names_of(decoded_robot_stream(bytes_from_hex("fafb06203bfb051b40"))), std::vector<std::string>{"VEL2"});
}

TEST(Decode, ReadsBothEndsOfTheLaserLine) {
  const auto stream = decoded_laser_stream(
      bytes_from_hex("0200020020253508 06 02800300a00010160a 15 00 02800e00b00540e803d027ff1ffe1ff71f103817"), {});
  EXPECT_EQ(names_of(stream), (std::vector<std::string>{"set mode", "ACK", "mode", "NAK", "scan"}));
}

TEST(Decode, ReadsRangesInTheModeThatIsGiven) {
  const Outcome outcome = run({"laser", "02800e00b00540e803d027ff1ffe1ff71f103817", "--measuring-mode", "0", "--json"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.complained;
  const auto fields = nlohmann::json::parse(outcome.printed)["frames"][0]["fields"];
  EXPECT_EQ(fields["beams_m"], (nlohmann::json{"1.000", "2.000", "not valid", "dazzled", "beyond maximum"}));
  EXPECT_EQ(fields["words"][1], 10192);
}

TEST(Decode, NamesTheCodesOfEveryMeasuringMode) {
  struct Case {
    std::uint8_t mode;
    unsigned first;  // x..F7
  };
  for (const Case& c : {Case{0x00, 0x1FF7}, Case{0x03, 0x3FF7}, Case{0x06, 0x7FF7}, Case{0x0F, 0x7FF7}}) {
    drivers::lms200::Measurement measurement;
    for (const unsigned after : {0u, 3u, 4u, 6u, 7u, 8u}) {
      measurement.words.push_back(static_cast<std::uint16_t>(c.first + after));
    }
    const auto stream = decoded_laser_stream(encoded_measurement(measurement), c.mode);
    ASSERT_EQ(stream.frames.size(), 1u);
    const auto& fields = stream.frames[0].fields;
    const auto beams = std::find_if(fields.begin(), fields.end(), [](const auto& f) { return f.first == "beams_m"; });
    ASSERT_NE(beams, fields.end());
    EXPECT_EQ(std::get<std::vector<std::string>>(beams->second),
              (std::vector<std::string>{"beyond maximum", "channel 1 error", "signal too weak", "overflow", "dazzled",
                                        "not valid"}))
        << int{c.mode};
  }
}

TEST(Decode, NamesTheTelegramsOfSelectedValues) {
  using namespace drivers::lms200;
  using Kind = ValueSelection::Kind;
  std::vector<std::uint8_t> line;
  const auto add = [&](const std::vector<std::uint8_t>& frame) { line.insert(line.end(), frame.begin(), frame.end()); };
  add(selection_request({Kind::kSubRange, 1, {{1, 2}}}, true));
  add(selection_request({Kind::kMean, 4, {}}, false));
  add(selection_request({Kind::kEverySecond, 1, {}}, false));
  Measurement measurement;
  measurement.words = {100, 200};
  add(encoded_selected_values({4, std::nullopt, measurement}));
  add(encoded_selected_values({std::nullopt, ValueRange{1, 2}, measurement}));
  add(encoded_selected_values({4, ValueRange{1, 2}, measurement}));
  add(encoded_reflecting_ranges({{{1, 2}, measurement, {7, 8}}}));
  add(counters_reply({1200, 300}));
  add(configuration_2_reply());
  add(permanent_baud_reply(true, false));
  const auto stream = decoded_laser_stream(line, 0x00);
  EXPECT_EQ(names_of(stream), (std::vector<std::string>{"set mode", "request mean scan", "request scan", "mean scan",
                                                        "sub-range", "mean sub-range", "ranges with reflectivity",
                                                        "counters", "configuration 2", "permanent baud"}));
  for (std::size_t i = 0; i < stream.frames.size(); ++i) {
    const auto& fields = stream.frames[i].fields;
    const bool is_raw = std::any_of(fields.begin(), fields.end(), [](const auto& f) { return f.first == "data"; });
    EXPECT_EQ(is_raw, stream.frames[i].name == "configuration 2") << stream.frames[i].name << ": its fields are told";
  }
}

TEST(Decode, PrintsTextForPeople) {
  const Outcome outcome = run({"robot", "fafb06043b0100053b"});
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_EQ(outcome.printed, "ENABLE  (from host, byte 0, 9 bytes)\n  command: 4\n  argument: 1\n");
}

TEST(Decode, SaysInOneLineWhyNothingDecodes) {
  const auto complaint = [](std::vector<const char*> arguments) {
    const Outcome outcome = run(std::move(arguments));
    EXPECT_EQ(outcome.exit_code, 1);
    return outcome.complained;
  };
  EXPECT_EQ(complaint({"robot", "fafb060b3bc800d33c"}),
            "deltamap: decode robot: no frame in 9 bytes: wrong checksum\n");
  EXPECT_EQ(complaint({"robot", "fafbff0000"}), "deltamap: decode robot: no frame in 5 bytes: impossible length\n");
  EXPECT_EQ(complaint({"laser", "0200020020243409"}), "deltamap: decode laser: no frame in 8 bytes: wrong checksum\n");
  EXPECT_EQ(complaint({"laser", "0280"}), "deltamap: decode laser: no frame in 2 bytes: cut short\n");
  EXPECT_EQ(complaint({"laser", "aabb"}), "deltamap: decode laser: no frame in 2 bytes: no header\n");
}

TEST(Decode, RefusesWhatIsNoHexAndLinesThatDoNotExist) {
  EXPECT_EQ(run({"robot", "fafb0"}).exit_code, 2);
  EXPECT_EQ(run({"robot", "xyzw"}).exit_code, 2);
  EXPECT_EQ(run({"sonar", "00"}).exit_code, 2);
  EXPECT_EQ(run({"robot"}).exit_code, 2);
}

TEST(Decode, RefusesWhatIsOfARecordingBesideBytes) {
  for (const char* option : {"--kind", "--from", "--to"}) {
    const Outcome told = run({"robot", "fafb0300000000", option, option[2] == 'k' ? "SIP" : "1"});
    EXPECT_EQ(told.exit_code, 2) << option;
    EXPECT_NE(told.complained.find(option), std::string::npos) << told.complained;
  }
}

TEST(Decode, DecodesEveryGoldenFrameWhole) {
  DELTAMAP_GOLDEN_VECTORS_OR_SKIP(golden);
  for (const char* list : {"arcos_commands", "arcos_sips", "arcos_replies_captured"}) {
    for (const auto& vector : golden[list]) {
      const auto bytes = bytes_from_hex(vector["hex"].get<std::string>());
      const auto stream = decoded_robot_stream(bytes);
      ASSERT_EQ(stream.frames.size(), 1u) << vector["name"];
      EXPECT_EQ(stream.frames[0].size, bytes.size()) << vector["name"];
      EXPECT_NE(stream.frames[0].name, "packet of unknown type") << vector["name"];
    }
  }
  for (const char* list : {"lms_host", "lms_device", "lms_scan_decode"}) {
    for (const auto& vector : golden[list]) {
      const auto bytes = bytes_from_hex(vector["hex"].get<std::string>());
      const auto stream = decoded_laser_stream(bytes, {});
      ASSERT_EQ(stream.frames.size(), 1u) << vector["name"];
      EXPECT_EQ(stream.frames[0].size, bytes.size()) << vector["name"];
    }
  }
}

}  // namespace
}  // namespace deltamap::tool
