// SPDX-License-Identifier: Apache-2.0
// Commands from the host to the robot (protocols.md A3, A5): a number and at most one argument.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace deltamap::drivers::pioneer {

/// Numbers of A5. SYNC0, SYNC1 and SYNC2 have the bytes of PULSE, OPEN and CLOSE: what they mean depends on whether
/// the robot is connected (A4).
enum class CommandNumber : std::uint8_t {
  kPulse = 0,
  kOpen = 1,
  kClose = 2,
  kPolling = 3,
  kEnable = 4,
  kSetA = 5,
  kSetV = 6,
  kSetO = 7,
  kMove = 8,
  kRotate = 9,
  kSetRv = 10,
  kVel = 11,
  kHead = 12,
  kDhead = 13,
  kConfig = 18,
  kEncoder = 19,
  kRvel = 21,
  kSetRa = 23,
  kImuRequest = 26,
  kSonar = 28,
  kStop = 29,
  kDigOut = 30,
  kVel2 = 32,
  kAdSel = 35,
  kGyroCalCw = 38,
  kGyroCalCcw = 39,
  kIoRequest = 40,
  kBumpStall = 44,
  kJoyDrive = 47,
  kSonarCycle = 48,
  kHostBaud = 50,
  kAux1Baud = 51,
  kAux2Baud = 52,
  kAux3Baud = 53,
  kEstop = 55,
  kEstall = 56,
  kQstop = 57,
  kGyro = 58,
  kBatteryInfo = 62,
  kBatTest = 250,
  kReset = 253,
  kMaintenance = 255
};

/// No argument; a whole number in [-65535, 65535], sent as sign and magnitude (A3); or a string of at most 199 bytes.
using CommandArgument = std::variant<std::monostate, int, std::string>;

struct Command {
  CommandNumber number = CommandNumber::kPulse;
  CommandArgument argument;

  friend bool operator==(const Command&, const Command&) = default;

  /// The whole number; what stands in for one that was not sent.
  [[nodiscard]] int integer_or(int otherwise) const;
};

/// The two signed bytes of VEL2 and DIGOUT, in units of 20 mm/s for VEL2 (A3).
struct BytePair {
  std::int8_t left = 0;   ///< high byte
  std::int8_t right = 0;  ///< low byte
  friend bool operator==(const BytePair&, const BytePair&) = default;
};

/// "VEL"; "command 99" for a number that A5 does not list.
[[nodiscard]] std::string command_name(CommandNumber number);

/// The whole frame, FA to checksum.
[[nodiscard]] std::vector<std::uint8_t> encoded_command(const Command& command);

/// From the data of a packet, command number first. Unknown numbers are kept; an argument of a kind that A3 does not
/// know, or shorter than it says, is refused, but a bare kind byte is read as no argument (Player's SETO, A5). Bytes
/// after the first argument are ignored.
[[nodiscard]] std::optional<Command> decoded_command(std::span<const std::uint8_t> data);

/// A negative 16-bit value is negated before it is split (A3).
[[nodiscard]] BytePair byte_pair(int argument);
[[nodiscard]] Command byte_pair_command(CommandNumber number, BytePair pair);

/// HOSTBAUD's code 0..4 for 9600..115200 (A5).
[[nodiscard]] std::optional<int> host_baud_code(unsigned baud);
[[nodiscard]] std::optional<unsigned> baud_of_host_code(int code);

}  // namespace deltamap::drivers::pioneer
