// SPDX-License-Identifier: Apache-2.0
#include "tool/decode/frame_reader.hpp"

#include <utility>
#include <vector>

namespace deltamap::tool {
namespace {

using drivers::DecoderCounts;
using drivers::lms200::Sender;
using drivers::lms200::Telegram;
using drivers::lms200::TelegramDecoder;
using drivers::pioneer::Packet;
using drivers::pioneer::PacketDecoder;
using drivers::port::Direction;
using drivers::port::PortId;

constexpr unsigned kUnknownBaud = 9600;  // until a record tells

DecoderCounts difference(const DecoderCounts& now, const DecoderCounts& before) {
  DecoderCounts more;
  more.garbage_bytes = now.garbage_bytes - before.garbage_bytes;
  more.bad_length = now.bad_length - before.bad_length;
  more.bad_checksum = now.bad_checksum - before.bad_checksum;
  more.truncated = now.truncated - before.truncated;
  return more;
}

/// `work` has the decoder find frames: what it finds besides is told before they are.
template <typename Decoder, typename Work, typename Frame>
void hand_over(Decoder& decoder, const Work& work, const LineEnd& line, const FrameReader::Sinks& sinks,
               const std::function<void(const Frame&, const LineEnd&)>& sink) {
  const DecoderCounts before = decoder.counts();
  const std::vector<Frame> frames = work(decoder);
  const DecoderCounts more = difference(decoder.counts(), before);
  if (more.errors() > 0) sinks.garbage(more, line);
  for (const Frame& frame : frames) sink(frame, line);
}

}  // namespace

FrameReader::FrameReader()
    : robot_{PacketDecoder{kUnknownBaud}, PacketDecoder{kUnknownBaud}},
      laser_{TelegramDecoder{Sender::kDevice, kUnknownBaud}, TelegramDecoder{Sender::kHost, kUnknownBaud}} {}

void FrameReader::feed(const drivers::port::ByteRecord& record, const Sinks& sinks) {
  const bool is_robot = record.port == PortId::kRobot;
  for (const Direction direction : {Direction::kIn, Direction::kOut}) {
    const LineEnd line{record.port, direction};
    const auto at = static_cast<std::size_t>(direction);
    const auto work = [&](auto& decoder) {
      if (record.baud > 0) decoder.set_baud(record.baud);
      const bool has_bytes = !record.bytes.empty() && record.direction == direction;
      return has_bytes ? decoder.decode(record.bytes, record.stamp) : decltype(decoder.finish()){};
    };
    is_robot ? hand_over<PacketDecoder, decltype(work), Packet>(robot_[at], work, line, sinks, sinks.packet)
             : hand_over<TelegramDecoder, decltype(work), Telegram>(laser_[at], work, line, sinks, sinks.telegram);
  }
}

const DecoderCounts& FrameReader::counts(const LineEnd& line) const {
  const auto at = static_cast<std::size_t>(line.direction);
  return line.port == PortId::kRobot ? robot_[at].counts() : laser_[at].counts();
}

}  // namespace deltamap::tool
