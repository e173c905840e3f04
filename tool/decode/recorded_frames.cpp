// SPDX-License-Identifier: Apache-2.0
#include "tool/decode/recorded_frames.hpp"

#include <utility>

#include "drivers/lms200/command.hpp"
#include "drivers/lms200/status.hpp"

namespace deltamap::tool {
namespace {

namespace laser = drivers::lms200;
using drivers::port::Direction;

Timestamp time_of(Timestamp first_byte, Timestamp received, const LineEnd& line) {
  return line.direction == Direction::kIn ? first_byte : received;
}

}  // namespace

RecordedFrames::RecordedFrames(std::optional<std::uint8_t> measuring_mode, Sink sink)
    : sink_{std::move(sink)},
      sinks_{[this](const drivers::pioneer::Packet& packet, const LineEnd& line) { take(packet, line); },
             [this](const laser::Telegram& telegram, const LineEnd& line) { take(telegram, line); },
             [this](const drivers::DecoderCounts& garbage, const LineEnd& line) { take(garbage, line); }},
      is_mode_given_{measuring_mode},
      mode_{measuring_mode} {}

void RecordedFrames::feed(const drivers::port::ByteRecord& record) {
  stamp_ = record.stamp;
  after_s_ = passed_.after_s(record.stamp);
  if (!record.note.empty()) {
    hand_over(stamp_, {record.port, Direction::kIn}, {kNoteName, "deltamap", 0, 0, {{"text", record.note}}});
  }
  reader_.feed(record, sinks_);
}

void RecordedFrames::take(const drivers::pioneer::Packet& packet, const LineEnd& line) {
  hand_over(time_of(packet.first_byte, packet.received, line), line, robot_frame(packet, line.direction));
}

void RecordedFrames::take(const laser::Telegram& telegram, const LineEnd& line) {
  if (!is_mode_given_ && line.direction == Direction::kIn) learn_mode(telegram);
  hand_over(time_of(telegram.first_byte, telegram.received, line), line, laser_frame(telegram, line.direction, mode_));
}

void RecordedFrames::take(const drivers::DecoderCounts& garbage, const LineEnd& line) {
  DecodedFrame frame{kGarbageName,
                     line.direction == Direction::kOut ? "host" : std::string(name_of(line.port)),
                     0,
                     static_cast<std::size_t>(garbage.garbage_bytes),
                     {}};
  const std::pair<const char*, std::uint64_t> causes[] = {{"impossible_length", garbage.bad_length},
                                                          {"wrong_checksum", garbage.bad_checksum},
                                                          {"cut_short", garbage.truncated}};
  for (const auto& [cause, count] : causes) {
    if (count > 0) frame.fields.emplace_back(cause, whole(static_cast<std::int64_t>(count)));
  }
  hand_over(stamp_, line, std::move(frame));
}

/// A laser that starts up may measure in another mode (protocols.md B4).
void RecordedFrames::learn_mode(const laser::Telegram& telegram) {
  if (telegram.kind != laser::Telegram::Kind::kTelegram) return;
  if (telegram.command == laser::response::kPowerOn) mode_.reset();
  if (const auto status = laser::decoded_status(telegram)) mode_ = status->measuring_mode;
  if (const auto configuration = laser::decoded_configuration(telegram)) mode_ = configuration->measuring_mode();
  if (const auto written = laser::decoded_write_reply(telegram)) mode_ = written->active.measuring_mode();
}

void RecordedFrames::hand_over(Timestamp time, const LineEnd& line, DecodedFrame frame) const {
  sink_({time, after_s_ + seconds(time - stamp_), after_s_, line, std::move(frame)});
}

}  // namespace deltamap::tool
