// SPDX-License-Identifier: Apache-2.0
// From the records of a recording to the frames that passed its ports, in both directions: what the devices have said,
// and what was said to them.
#pragma once

#include <array>
#include <functional>

#include "drivers/decoder_counts.hpp"
#include "drivers/lms200/telegram.hpp"
#include "drivers/pioneer/packet.hpp"
#include "drivers/port/byte_record.hpp"

namespace deltamap::tool {

/// One direction of one port.
struct LineEnd {
  drivers::port::PortId port = drivers::port::PortId::kRobot;
  drivers::port::Direction direction = drivers::port::Direction::kIn;
};

class FrameReader {
 public:
  struct Sinks {
    std::function<void(const drivers::pioneer::Packet&, const LineEnd&)> packet;
    std::function<void(const drivers::lms200::Telegram&, const LineEnd&)> telegram;
    /// Bytes that belong to no frame and headers that begin none, before the frames of the same record.
    std::function<void(const drivers::DecoderCounts&, const LineEnd&)> garbage;
  };

  FrameReader();

  /// Hands over what the record completes. What waits for its end when a recording ends is neither frame nor garbage,
  /// as in a replay.
  void feed(const drivers::port::ByteRecord& record, const Sinks& sinks);

  [[nodiscard]] const drivers::DecoderCounts& counts(const LineEnd& line) const;

 private:
  /// Of each direction, by Direction.
  std::array<drivers::pioneer::PacketDecoder, 2> robot_;
  std::array<drivers::lms200::TelegramDecoder, 2> laser_;
};

}  // namespace deltamap::tool
