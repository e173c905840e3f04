// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "drivers/lms200/command.hpp"
#include "drivers/lms200/measurement.hpp"
#include "drivers/lms200/status.hpp"
#include "drivers/lms200/telegram.hpp"
#include "drivers/lms200/value_selection.hpp"
#include "tool/decode/decoded_frame.hpp"

namespace deltamap::tool {
namespace {

using namespace drivers::lms200;
using drivers::port::Direction;

constexpr unsigned kAnyBaud = 38400;  // times do not matter here

std::string text_of(const std::vector<std::uint8_t>& data) {
  std::string text;
  for (const std::uint8_t byte : data) text.push_back(byte >= 0x20 && byte < 0x7F ? static_cast<char>(byte) : '.');
  return text;
}

void add_scan(const Measurement& measurement, std::optional<std::uint8_t> measuring_mode, NamedFields& fields) {
  fields.emplace_back("values", whole(static_cast<std::int64_t>(measurement.words.size())));
  fields.emplace_back("metres_per_word", measurement.metres_per_word());
  fields.emplace_back("partial", measurement.is_partial);
  if (measurement.is_partial) fields.emplace_back("partial_offset_deg", 0.25 * measurement.partial_number);
  if (measurement.indices) {
    fields.emplace_back("scan_index", whole(measurement.indices->scan));
    fields.emplace_back("telegram_index", whole(measurement.indices->telegram));
  }
  fields.emplace_back("words", std::vector<std::int64_t>(measurement.words.begin(), measurement.words.end()));
  const std::optional<RangeCoding> coding = measuring_mode ? range_coding(*measuring_mode) : std::nullopt;
  if (!coding) return;
  std::vector<std::string> beams;
  for (const std::uint16_t word : measurement.words) {
    beams.push_back(code_name(word, *coding).value_or(""));
    if (!beams.back().empty()) continue;
    const unsigned value = word & coding->range_mask;
    std::string metres = std::to_string(value * measurement.metres_per_word());
    metres.resize(metres.find('.') + 4);
    beams.back() = value > 0 ? metres : "not valid";
  }
  fields.emplace_back("beams_m", beams);
}

void add_range(const ValueRange& range, NamedFields& fields) {
  fields.emplace_back("from", whole(range.from));
  fields.emplace_back("to", whole(range.to));
}

void add_selected(const SelectedValues& selected, std::optional<std::uint8_t> measuring_mode, NamedFields& fields) {
  if (selected.mean_of) fields.emplace_back("mean_of", whole(*selected.mean_of));
  if (selected.range) add_range(*selected.range, fields);
  add_scan(selected.measurement, measuring_mode, fields);
}

void add_reflecting(const std::vector<ReflectingRange>& parts, std::optional<std::uint8_t> measuring_mode,
                    NamedFields& fields) {
  fields.emplace_back("ranges", whole(static_cast<std::int64_t>(parts.size())));
  for (const ReflectingRange& part : parts) {
    add_range(part.range, fields);
    add_scan(part.measurement, measuring_mode, fields);
    fields.emplace_back("reflectivity", std::vector<std::int64_t>(part.reflectivity.begin(), part.reflectivity.end()));
  }
}

void add_selection(const ValueSelection& selection, NamedFields& fields) {
  if (selection.mean_of > 1) fields.emplace_back("mean_of", whole(selection.mean_of));
  for (const ValueRange& range : selection.ranges) add_range(range, fields);
}

void add_configuration(const Configuration& configuration, NamedFields& fields) {
  const auto& bytes = configuration.bytes;
  fields.emplace_back("blanking_cm", whole(bytes[0] | bytes[1] << 8));
  fields.emplace_back("stop_threshold_mv", whole(bytes[2]));
  fields.emplace_back("sensitivity", whole(bytes[3]));
  fields.emplace_back("availability", whole(bytes[4]));
  fields.emplace_back("measuring_mode", whole(configuration.measuring_mode()));
  fields.emplace_back("units", std::string(configuration.units() == Units::kMillimetre ? "mm" : "cm"));
  fields.emplace_back("multiple_evaluation", whole(bytes[9]));
  fields.emplace_back("restart_mode", whole(bytes[10]));
  fields.emplace_back("bytes", std::vector<std::int64_t>(bytes.begin(), bytes.end()));
}

void add_status(const DeviceStatus& status, NamedFields& fields) {
  fields.emplace_back("software_version", status.software_version);
  fields.emplace_back("operating_mode", whole(status.operating_mode));
  fields.emplace_back("fault", whole(status.fault));
  fields.emplace_back("measuring_mode", whole(status.measuring_mode));
  fields.emplace_back("variant", name_of({status.scan_angle_deg, status.resolution_centideg}));
  fields.emplace_back("units", std::string(status.units == 1 ? "mm" : "cm"));
  fields.emplace_back("baud", whole(status.baud().value_or(0)));
  fields.emplace_back("permanent_baud", status.permanent_baud != 0);
  fields.emplace_back("address", whole(status.address));
  fields.emplace_back("laser_on", status.laser_on != 0);
  fields.emplace_back("pollution", std::vector<std::int64_t>(status.pollution.begin(), status.pollution.end()));
  fields.emplace_back("boot_version", status.boot_version);
}

/// Answers whether the content was understood.
bool add_reply(const Telegram& telegram, std::optional<std::uint8_t> measuring_mode, NamedFields& fields) {
  if (const auto measurement = decoded_measurement(telegram)) {
    add_scan(*measurement, measuring_mode, fields);
  } else if (const auto selected = decoded_selected_values(telegram)) {
    add_selected(*selected, measuring_mode, fields);
  } else if (const auto parts = decoded_reflecting_ranges(telegram)) {
    add_reflecting(*parts, measuring_mode, fields);
  } else if (const auto counters = decoded_counters(telegram)) {
    fields.emplace_back("hours", whole(counters->hours));
    fields.emplace_back("switch_ons", whole(counters->switch_ons));
  } else if (const auto permanent = decoded_permanent_baud_reply(telegram)) {
    fields.emplace_back("accepted", permanent->accepted);
    fields.emplace_back("permanent", permanent->is_permanent);
  } else if (const auto status = decoded_status(telegram)) {
    add_status(*status, fields);
  } else if (const auto configuration = decoded_configuration(telegram)) {
    add_configuration(*configuration, fields);
  } else if (const auto written = decoded_write_reply(telegram)) {
    fields.emplace_back("accepted", written->accepted);
    add_configuration(written->active, fields);
  } else if (const auto variant = decoded_variant_reply(telegram)) {
    fields.emplace_back("accepted", variant->accepted);
    fields.emplace_back("variant", name_of(variant->active));
  } else if (const auto switched = mode_was_switched(telegram)) {
    fields.emplace_back("switched", *switched);
  } else if (telegram.command == response::kType || telegram.command == response::kPowerOn) {
    fields.emplace_back("text", text_of(telegram.data));
  } else {
    return telegram.data.empty();
  }
  return true;
}

bool add_request(const Telegram& telegram, NamedFields& fields) {
  if (const auto variant = requested_variant(telegram)) {
    fields.emplace_back("variant", name_of(*variant));
  } else if (telegram.command == command::kWriteConfiguration) {
    const auto configuration = configuration_with(telegram.data, {});
    if (!configuration) return false;
    add_configuration(*configuration, fields);
  } else if (telegram.command == command::kSetMode && !telegram.data.empty()) {
    const std::uint8_t mode = telegram.data[0];
    fields.emplace_back("mode", whole(mode));
    fields.emplace_back("meaning", mode_name(mode));
    if (const auto baud = baud_of_mode(mode)) fields.emplace_back("baud", whole(*baud));
    if (mode == mode::kInstallation)
      fields.emplace_back("password", text_of({telegram.data.begin() + 1, telegram.data.end()}));
    const auto selection = requested_selection(telegram);
    if (selection) add_selection(*selection, fields);
    return mode == mode::kInstallation || telegram.data.size() == 1 || selection;
  } else if (const auto selection = requested_selection(telegram)) {
    if (telegram.command == command::kRequestScan) fields.emplace_back("which", whole(telegram.data[0]));
    add_selection(*selection, fields);
  } else {
    return telegram.data.empty();
  }
  return true;
}

}  // namespace

DecodedFrame laser_frame(const Telegram& telegram, Direction direction, std::optional<std::uint8_t> measuring_mode) {
  const bool is_from_laser = direction == Direction::kIn;
  DecodedFrame frame;
  frame.from = is_from_laser ? "laser" : "host";
  frame.size = 1;
  if (telegram.kind == Telegram::Kind::kTelegram) {
    frame.name = telegram_name(telegram.command);
    frame.size = telegram.data.size() + kFrameOverhead + (is_from_laser ? 2 : 1);
    frame.fields.emplace_back("address", whole(telegram.address));
    frame.fields.emplace_back(is_from_laser ? "response" : "command", whole(telegram.command));
    const bool understood =
        is_from_laser ? add_reply(telegram, measuring_mode, frame.fields) : add_request(telegram, frame.fields);
    if (!understood) {
      frame.fields.emplace_back("data", std::vector<std::int64_t>(telegram.data.begin(), telegram.data.end()));
    }
    if (is_from_laser) frame.fields.emplace_back("status", whole(telegram.status));
  } else {
    frame.name = telegram.kind == Telegram::Kind::kAck ? "ACK" : "NAK";
  }
  return frame;
}

namespace {

DecodedStream stream_from(std::span<const std::uint8_t> bytes, Sender sender, std::optional<std::uint8_t> mode) {
  const Direction direction = sender == Sender::kDevice ? Direction::kIn : Direction::kOut;
  DecodedStream stream;
  TelegramDecoder decoder{sender, kAnyBaud};
  const auto take = [&](const std::vector<Telegram>& telegrams) {
    for (const Telegram& telegram : telegrams) {
      stream.frames.push_back(laser_frame(telegram, direction, mode));
      DecodedFrame& frame = stream.frames.back();
      // Byte i was handed in at i ns.
      frame.at = static_cast<std::size_t>(unix_ns(telegram.received)) + 1 - frame.size;
    }
  };
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    take(decoder.decode(bytes.subspan(i, 1), timestamp_from_ns(static_cast<std::int64_t>(i))));
  }
  take(decoder.finish());
  stream.counts = decoder.counts();
  return stream;
}

}  // namespace

DecodedStream decoded_laser_stream(std::span<const std::uint8_t> bytes, std::optional<std::uint8_t> measuring_mode) {
  DecodedStream stream = stream_from(bytes, Sender::kDevice, measuring_mode);
  const DecodedStream requests = stream_from(bytes, Sender::kHost, measuring_mode);
  stream.counts.bad_length += requests.counts.bad_length;
  stream.counts.bad_checksum += requests.counts.bad_checksum;
  stream.counts.truncated += requests.counts.truncated;
  // A request may be found inside the words of a scan: what the laser's own telegrams cover is theirs.
  for (const DecodedFrame& request : requests.frames) {
    const bool is_free = std::none_of(stream.frames.begin(), stream.frames.end(), [&](const DecodedFrame& reply) {
      return request.at < reply.at + reply.size && reply.at < request.at + request.size;
    });
    if (!is_free) continue;
    stream.frames.push_back(request);
    // The acknowledgement that follows a request is garbage to neither end.
    const std::size_t after = request.at + request.size;
    const bool is_acknowledged = after < bytes.size() && (bytes[after] == kAckByte || bytes[after] == kNakByte);
    const bool is_known = std::any_of(stream.frames.begin(), stream.frames.end(),
                                      [&](const DecodedFrame& frame) { return frame.at == after; });
    if (is_acknowledged && !is_known) {
      stream.frames.push_back({bytes[after] == kAckByte ? "ACK" : "NAK", "laser", after, 1, {}});
    }
  }
  std::sort(stream.frames.begin(), stream.frames.end(),
            [](const DecodedFrame& a, const DecodedFrame& b) { return a.at < b.at; });
  return stream;
}

}  // namespace deltamap::tool
