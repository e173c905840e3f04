// SPDX-License-Identifier: Apache-2.0
#include "drivers/pioneer/command.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cstdlib>

#include "drivers/byte_fields.hpp"
#include "drivers/pioneer/packet.hpp"

namespace deltamap::drivers::pioneer {
namespace {

constexpr std::uint8_t kPositive = 0x3B;
constexpr std::uint8_t kNegative = 0x1B;
constexpr std::uint8_t kString = 0x2B;
[[maybe_unused]] constexpr int kMaxMagnitude = 65535;
[[maybe_unused]] constexpr std::size_t kMaxString = kMaxData - 3;

constexpr std::array<unsigned, 5> kHostBauds{9600, 19200, 38400, 57600, 115200};

struct NamedCommand {
  CommandNumber number;
  const char* name;
};

constexpr auto kNames = std::to_array<NamedCommand>({
    {CommandNumber::kPulse, "PULSE"},
    {CommandNumber::kOpen, "OPEN"},
    {CommandNumber::kClose, "CLOSE"},
    {CommandNumber::kPolling, "POLLING"},
    {CommandNumber::kEnable, "ENABLE"},
    {CommandNumber::kSetA, "SETA"},
    {CommandNumber::kSetV, "SETV"},
    {CommandNumber::kSetO, "SETO"},
    {CommandNumber::kMove, "MOVE"},
    {CommandNumber::kRotate, "ROTATE"},
    {CommandNumber::kSetRv, "SETRV"},
    {CommandNumber::kVel, "VEL"},
    {CommandNumber::kHead, "HEAD"},
    {CommandNumber::kDhead, "DHEAD"},
    {CommandNumber::kConfig, "CONFIG"},
    {CommandNumber::kEncoder, "ENCODER"},
    {CommandNumber::kRvel, "RVEL"},
    {CommandNumber::kSetRa, "SETRA"},
    {CommandNumber::kImuRequest, "IMU"},
    {CommandNumber::kSonar, "SONAR"},
    {CommandNumber::kStop, "STOP"},
    {CommandNumber::kDigOut, "DIGOUT"},
    {CommandNumber::kVel2, "VEL2"},
    {CommandNumber::kAdSel, "ADSEL"},
    {CommandNumber::kGyroCalCw, "GYROCALCW"},
    {CommandNumber::kGyroCalCcw, "GYROCALCCW"},
    {CommandNumber::kIoRequest, "IOREQUEST"},
    {CommandNumber::kBumpStall, "BUMPSTALL"},
    {CommandNumber::kJoyDrive, "JOYDRIVE"},
    {CommandNumber::kSonarCycle, "SONARCYCLE"},
    {CommandNumber::kHostBaud, "HOSTBAUD"},
    {CommandNumber::kAux1Baud, "AUX1BAUD"},
    {CommandNumber::kAux2Baud, "AUX2BAUD"},
    {CommandNumber::kAux3Baud, "AUX3BAUD"},
    {CommandNumber::kEstop, "ESTOP"},
    {CommandNumber::kEstall, "ESTALL"},
    {CommandNumber::kQstop, "QSTOP"},
    {CommandNumber::kGyro, "GYRO"},
    {CommandNumber::kBatteryInfo, "BATTERYINFO"},
    {CommandNumber::kBatTest, "BATTEST"},
    {CommandNumber::kReset, "RESET"},
    {CommandNumber::kMaintenance, "MAINTENANCE"},
});

}  // namespace

int Command::integer_or(int otherwise) const {
  const int* value = std::get_if<int>(&argument);
  return value != nullptr ? *value : otherwise;
}

std::string command_name(CommandNumber number) {
  const auto found =
      std::find_if(kNames.begin(), kNames.end(), [&](const NamedCommand& n) { return n.number == number; });
  return found != kNames.end() ? found->name : "command " + std::to_string(static_cast<unsigned>(number));
}

std::vector<std::uint8_t> encoded_command(const Command& command) {
  FieldWriter data;
  data.u8(static_cast<unsigned>(command.number));
  if (const int* value = std::get_if<int>(&command.argument)) {
    assert(std::abs(*value) <= kMaxMagnitude && "an argument has 16 bits of magnitude");
    data.u8(*value < 0 ? kNegative : kPositive).u16(static_cast<unsigned>(std::abs(*value)));
  } else if (const std::string* text = std::get_if<std::string>(&command.argument)) {
    assert(text->size() <= kMaxString && "a string argument fits one packet");
    data.u8(kString).u8(static_cast<unsigned>(text->size())).text(*text);
  }
  return encoded_packet(data.written());
}

std::optional<Command> decoded_command(std::span<const std::uint8_t> data) {
  if (data.empty()) return std::nullopt;
  FieldReader fields{data};
  Command command{static_cast<CommandNumber>(fields.u8()), {}};
  if (fields.left() == 0) return command;
  const std::uint8_t kind = fields.u8();
  const bool is_known_kind = kind == kPositive || kind == kNegative || kind == kString;
  if (!is_known_kind) return std::nullopt;
  if (fields.left() == 0) return command;
  if (kind == kString) {
    const std::size_t size = fields.u8();
    command.argument = fields.text(size);
  } else {
    const int magnitude = fields.u16();
    command.argument = kind == kNegative ? -magnitude : magnitude;
  }
  if (!fields.is_good()) return std::nullopt;
  return command;
}

BytePair byte_pair(int argument) {
  const unsigned bits = static_cast<unsigned>(argument) & 0xFFFFu;
  return {static_cast<std::int8_t>(bits >> 8), static_cast<std::int8_t>(bits & 0xFF)};
}

Command byte_pair_command(CommandNumber number, BytePair pair) {
  const unsigned high = static_cast<std::uint8_t>(pair.left);
  const unsigned low = static_cast<std::uint8_t>(pair.right);
  return {number, static_cast<int>(high << 8 | low)};
}

std::optional<int> host_baud_code(unsigned baud) {
  const auto found = std::find(kHostBauds.begin(), kHostBauds.end(), baud);
  if (found == kHostBauds.end()) return std::nullopt;
  return static_cast<int>(found - kHostBauds.begin());
}

std::optional<unsigned> baud_of_host_code(int code) {
  if (code < 0 || code >= static_cast<int>(kHostBauds.size())) return std::nullopt;
  return kHostBauds[static_cast<std::size_t>(code)];
}

}  // namespace deltamap::drivers::pioneer
