// SPDX-License-Identifier: Apache-2.0
// A frame of either serial protocol in words, and what lay around it: what `deltamap decode` prints.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "drivers/decoder_counts.hpp"
#include "drivers/port/byte_record.hpp"

namespace deltamap::drivers::pioneer {
struct Packet;
}
namespace deltamap::drivers::lms200 {
struct Telegram;
}

namespace deltamap::tool {

using FieldValue =
    std::variant<bool, std::int64_t, double, std::string, std::vector<std::int64_t>, std::vector<std::string>>;

/// In the order of the wire.
using NamedFields = std::vector<std::pair<std::string, FieldValue>>;

/// As a field holds it.
[[nodiscard]] inline std::int64_t whole(std::int64_t value) { return value; }

struct DecodedFrame {
  std::string name;
  std::string from;      ///< "host", "robot", "laser" or "either"
  std::size_t at = 0;    ///< index of its first byte
  std::size_t size = 0;  ///< bytes
  NamedFields fields;
};

struct DecodedStream {
  std::vector<DecodedFrame> frames;  ///< in order
  drivers::DecoderCounts counts;     ///< why the rest is garbage
};

/// A packet of the Pioneer's line. Commands and replies share numbers: where the direction is not known, the form tells
/// which it is.
[[nodiscard]] DecodedFrame robot_frame(const drivers::pioneer::Packet& packet,
                                       std::optional<drivers::port::Direction> direction);

/// A telegram or acknowledgement of the laser's line. Ranges are read where the measuring mode is given: scans do not
/// tell it.
[[nodiscard]] DecodedFrame laser_frame(const drivers::lms200::Telegram& telegram, drivers::port::Direction direction,
                                       std::optional<std::uint8_t> measuring_mode);

/// Frames of the Pioneer's line, from either end (protocols.md A).
[[nodiscard]] DecodedStream decoded_robot_stream(std::span<const std::uint8_t> bytes);

/// Telegrams of the laser's line, from either end (protocols.md B).
[[nodiscard]] DecodedStream decoded_laser_stream(std::span<const std::uint8_t> bytes,
                                                 std::optional<std::uint8_t> measuring_mode);

}  // namespace deltamap::tool
