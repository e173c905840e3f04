// SPDX-License-Identifier: Apache-2.0
// What a recording is made of: one chunk of bytes as it passed a port, or a note between chunks (a change of baud, a
// scheduling decision). The same record travels from the recording port to the file and from the file to a replay.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/time.hpp"

namespace deltamap::drivers::port {

enum class PortId : std::uint8_t { kRobot, kLaser };
[[nodiscard]] constexpr std::string_view name_of(PortId port) { return port == PortId::kRobot ? "robot" : "laser"; }

enum class Direction : std::uint8_t { kIn, kOut };

struct ByteRecord {
  PortId port = PortId::kRobot;
  Direction direction = Direction::kIn;  ///< means nothing where there are no bytes
  Timestamp stamp;                       ///< in: when read() returned the chunk; out: when it was handed to the port
  std::vector<std::uint8_t> bytes;       ///< empty: only a note
  std::string note;                      ///< one line of text; empty: only bytes
  unsigned baud = 0;  ///< line speed in force, this record's own note included; filled by whoever reads a recording
  friend bool operator==(const ByteRecord&, const ByteRecord&) = default;
};

/// The note that marks a change of baud: "baud 38400".
[[nodiscard]] inline std::string baud_note(unsigned baud) { return "baud " + std::to_string(baud); }
/// The baud that such a note tells; nothing for any other note.
[[nodiscard]] std::optional<unsigned> baud_of_note(std::string_view note);

/// The note that marks the end of a recording that was closed: "recording ends at 1700000000000000000", Unix time, ns.
[[nodiscard]] inline std::string end_note(Timestamp end) { return "recording ends at " + std::to_string(unix_ns(end)); }
/// The time that such a note tells; nothing for any other note.
[[nodiscard]] std::optional<Timestamp> end_of_note(std::string_view note);

}  // namespace deltamap::drivers::port
