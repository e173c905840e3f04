// SPDX-License-Identifier: Apache-2.0
// The golden frames of tests/data in both directions: what a clone alone holds the LMS200 codecs against.
#include <gtest/gtest.h>

#include "drivers/lms200/command.hpp"
#include "drivers/lms200/measurement.hpp"
#include "drivers/lms200/status.hpp"
#include "drivers/lms200/telegram.hpp"
#include "tests/support/bytes/golden_frames.hpp"
#include "tests/support/bytes/hex.hpp"
#include "tests/support/files/figure.hpp"

namespace deltamap::drivers::lms200 {
namespace {

using nlohmann::json;
using tests::golden_stream;
using tests::GoldenFrame;
using tests::hex_of;

std::vector<Telegram> telegrams_of(Sender sender, std::span<const std::uint8_t> bytes) {
  TelegramDecoder decoder{sender, 38400};
  auto telegrams = decoder.decode(bytes, Timestamp{});
  for (Telegram& telegram : decoder.finish()) telegrams.push_back(std::move(telegram));
  return telegrams;
}

Telegram telegram_of(const GoldenFrame& frame, Sender sender = Sender::kDevice) {
  const auto telegrams = telegrams_of(sender, frame.bytes);
  EXPECT_EQ(telegrams.size(), 1u) << frame.name();
  return telegrams.empty() ? Telegram{} : telegrams[0];
}

/// The replies of one kind. There must be some.
std::vector<GoldenFrame> replies(const std::string& name) {
  std::vector<GoldenFrame> found;
  for (GoldenFrame& frame : golden_stream("lms_replies").frames) {
    if (frame.name() == name) found.push_back(std::move(frame));
  }
  EXPECT_FALSE(found.empty()) << name;
  return found;
}

ScanVariant variant_in(const json& fields) { return {fields["angle_deg"], fields["step_centideg"]}; }

std::vector<std::uint8_t> request_like(const json& fields) {
  const std::string name = fields["name"];
  if (name == "reset") return reset_request();
  if (name == "installation mode") return installation_request();
  if (name == "stream") return mode_request(mode::kStreamAll);
  if (name == "on request") return mode_request(mode::kOnRequest);
  if (name == "baud") return baud_request(fields["baud"]);
  if (name == "scan") return scan_request();
  if (name == "status") return status_request();
  if (name == "errors") return errors_request();
  if (name == "type") return type_request();
  if (name == "variant") return variant_request(variant_in(fields));
  if (name == "permanent baud") return permanent_baud_request(fields["on"]);
  if (name == "configuration") return configuration_request();
  Configuration configuration;
  const auto bytes = tests::bytes_from_hex(fields["data"].get<std::string>());
  std::copy(bytes.begin(), bytes.end(), configuration.bytes.begin());
  return write_configuration_request(configuration);
}

TEST(LmsFrames, AStreamOfThemIsCutWhereTheyEnd) {
  std::size_t frames = 0;
  for (const char* name : {"lms_requests", "lms_replies", "lms_scans"}) {
    const auto stream = golden_stream(name);
    const bool is_host = std::string(name) == "lms_requests";
    const auto telegrams = telegrams_of(is_host ? Sender::kHost : Sender::kDevice, stream.bytes);
    ASSERT_EQ(telegrams.size(), stream.frames.size()) << name;
    for (std::size_t i = 0; i < telegrams.size(); ++i) {
      const Telegram& t = telegrams[i];
      const GoldenFrame& frame = stream.frames[i];
      if (t.kind != Telegram::Kind::kTelegram) continue;
      const auto encoded = is_host ? encoded_request(t.command, t.data, t.address)
                                   : encoded_reply(t.command, t.data, t.status, t.address);
      EXPECT_EQ(hex_of(encoded), hex_of(frame.bytes)) << frame.name();
      EXPECT_EQ(t.command, frame.fields[is_host ? "command" : "response"]) << frame.name();
      if (!is_host) {
        EXPECT_EQ(t.status, frame.fields["state"]) << frame.name();
      }
    }
    frames += telegrams.size();
  }
  test::tell_figure("lms_frames", static_cast<double>(frames));
}

TEST(LmsFrames, RequestsHaveTheirBytes) {
  for (const GoldenFrame& frame : golden_stream("lms_requests").frames) {
    EXPECT_EQ(hex_of(request_like(frame.fields)), hex_of(frame.bytes)) << frame.name();
    const Telegram telegram = telegram_of(frame, Sender::kHost);
    EXPECT_EQ(hex_of(telegram.data), frame.fields["data"]) << frame.name();
    EXPECT_EQ(has_right_password(telegram), frame.name() == "installation mode");
    if (frame.name() == "variant") {
      EXPECT_EQ(requested_variant(telegram), variant_in(frame.fields));
    }
  }
}

TEST(LmsFrames, SingleBytesAcknowledgeOrRefuse) {
  EXPECT_EQ(telegram_of(replies("ACK")[0]).kind, Telegram::Kind::kAck);
  EXPECT_EQ(telegram_of(replies("NAK")[0]).kind, Telegram::Kind::kNak);
}

TEST(LmsFrames, ShortRepliesMeanWhatTheySay) {
  for (const GoldenFrame& frame : replies("mode")) {
    EXPECT_EQ(mode_was_switched(telegram_of(frame)), frame.fields["switched"].get<bool>());
    EXPECT_EQ(hex_of(mode_reply(frame.fields["switched"])), hex_of(frame.bytes));
  }
  for (const GoldenFrame& frame : replies("variant")) {
    const auto reply = decoded_variant_reply(telegram_of(frame));
    ASSERT_TRUE(reply);
    EXPECT_EQ(reply->accepted, frame.fields["accepted"]);
    EXPECT_EQ(reply->active, variant_in(frame.fields));
    EXPECT_EQ(hex_of(variant_reply(reply->accepted, reply->active)), hex_of(frame.bytes));
  }
  EXPECT_EQ(hex_of(refused_reply()), hex_of(replies("refused")[0].bytes));
  const GoldenFrame start = replies("power on")[0];
  EXPECT_EQ(hex_of(power_on_reply(start.fields["text"].get<std::string>())), hex_of(start.bytes));
  const GoldenFrame type = replies("type")[0];
  EXPECT_EQ(hex_of(type_reply(type.fields["text"].get<std::string>())), hex_of(type.bytes));
}

TEST(LmsFrames, ConfigurationsHaveTheirBytesModeAndUnits) {
  const GoldenFrame frame = replies("configuration")[0];
  const auto configuration = decoded_configuration(telegram_of(frame));
  ASSERT_TRUE(configuration);
  EXPECT_EQ(hex_of(configuration->bytes), frame.fields["bytes"]);
  EXPECT_EQ(configuration->measuring_mode(), frame.fields["mode"]);
  EXPECT_EQ(static_cast<int>(configuration->units()), frame.fields["units"]);
  EXPECT_EQ(configuration->sends_real_time_indices(), frame.fields["indices"]);
  EXPECT_EQ(hex_of(configuration_reply(*configuration)), hex_of(frame.bytes));
  for (const GoldenFrame& written : replies("configuration written")) {
    const auto reply = decoded_write_reply(telegram_of(written));
    ASSERT_TRUE(reply);
    EXPECT_EQ(reply->accepted, written.fields["accepted"]);
    EXPECT_EQ(hex_of(reply->active.bytes), written.fields["bytes"]);
    EXPECT_EQ(hex_of(configuration_written_reply(reply->accepted, reply->active)), hex_of(written.bytes));
  }
}

TEST(LmsFrames, AStatusHasItsFieldsAndBytes) {
  const GoldenFrame frame = replies("status")[0];
  const auto status = decoded_status(telegram_of(frame));
  ASSERT_TRUE(status);
  json expected = frame.fields;
  for (const char* place : {"at", "size", "name", "response", "state"}) expected.erase(place);
  const json ours{{"software_version", status->software_version},
                  {"operating_mode", status->operating_mode},
                  {"fault", status->fault},
                  {"variant_type", status->variant_type},
                  {"pollution", status->pollution},
                  {"reference_pollution", status->reference_pollution},
                  {"motor_revolutions", status->motor_revolutions},
                  {"measuring_mode", status->measuring_mode},
                  {"scan_angle_deg", status->scan_angle_deg},
                  {"resolution_centideg", status->resolution_centideg},
                  {"restart_mode", status->restart_mode},
                  {"restart_time", status->restart_time},
                  {"baud", status->baud().value_or(0)},
                  {"evaluations", status->evaluations},
                  {"permanent_baud", status->permanent_baud},
                  {"address", status->address},
                  {"field_set", status->field_set},
                  {"units", status->units},
                  {"laser_on", status->laser_on},
                  {"boot_version", status->boot_version}};
  EXPECT_EQ(ours, expected) << json::diff(expected, ours);
  EXPECT_EQ(hex_of(status_reply(*status)), hex_of(frame.bytes));
}

const char* name_of(BeamKind kind) {
  switch (kind) {
    case BeamKind::kBeyondMaximum:
      return "beyond maximum";
    case BeamKind::kNotValid:
      return "not valid";
    case BeamKind::kDazzled:
      return "dazzled";
    default:
      return "other";
  }
}

void expect_ranges(const GoldenFrame& frame, const Measurement& measurement) {
  const auto coding = range_coding(frame.fields["mode"]);
  ASSERT_TRUE(coding);
  constexpr double kFartherThanAnyMode_m = 1000.0;
  for (std::size_t i = 0; i < measurement.words.size(); ++i) {
    const Beam beam = decoded_beam(measurement.words[i], *coding, measurement.metres_per_word(), kFartherThanAnyMode_m);
    const json& expected = frame.fields["ranges"][i];
    if (expected.is_string()) {
      EXPECT_EQ(name_of(beam.kind), expected) << frame.fields["mode"] << " word " << measurement.words[i];
    } else {
      EXPECT_EQ(beam.kind, BeamKind::kRange) << frame.fields["mode"] << " word " << measurement.words[i];
      EXPECT_FLOAT_EQ(beam.range_m, expected.get<float>() * (frame.fields["unit"] == 1 ? 0.001F : 0.01F));
    }
  }
}

TEST(LmsFrames, ScansHaveTheirRangesCodesAndBytes) {
  for (const GoldenFrame& frame : golden_stream("lms_scans").frames) {
    const auto measurement = decoded_measurement(telegram_of(frame));
    ASSERT_TRUE(measurement);
    EXPECT_EQ(measurement->words.size(), frame.fields["count"]);
    EXPECT_EQ(measurement->unit_code, frame.fields["unit"]);
    EXPECT_EQ(measurement->status, frame.fields["state"]);
    EXPECT_EQ(measurement->is_partial, !frame.fields["partial"].is_null());
    if (measurement->is_partial) {
      EXPECT_EQ(measurement->partial_number, frame.fields["partial"]);
    }
    ASSERT_EQ(measurement->indices.has_value(), !frame.fields["indices"].empty());
    if (measurement->indices) {
      EXPECT_EQ(measurement->indices->scan, frame.fields["indices"][0]);
      EXPECT_EQ(measurement->indices->telegram, frame.fields["indices"][1]);
    }
    EXPECT_EQ(hex_of(encoded_measurement(*measurement)), hex_of(frame.bytes));
    expect_ranges(frame, *measurement);
  }
}

}  // namespace
}  // namespace deltamap::drivers::lms200
