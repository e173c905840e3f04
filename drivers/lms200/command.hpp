// SPDX-License-Identifier: Apache-2.0
// The requests that we send to an LMS200 and its answers, encoded and decoded (protocols.md B3).
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "drivers/lms200/configuration.hpp"
#include "drivers/lms200/telegram.hpp"
#include "drivers/lms200/variant.hpp"

namespace deltamap::drivers::lms200 {

namespace command {
inline constexpr std::uint8_t kReset = 0x10;
inline constexpr std::uint8_t kSetMode = 0x20;
inline constexpr std::uint8_t kRequestScan = 0x30;
inline constexpr std::uint8_t kRequestStatus = 0x31;
inline constexpr std::uint8_t kRequestErrors = 0x32;
inline constexpr std::uint8_t kRequestCounters = 0x35;
inline constexpr std::uint8_t kRequestMean = 0x36;
inline constexpr std::uint8_t kRequestSubRange = 0x37;
inline constexpr std::uint8_t kRequestType = 0x3A;
inline constexpr std::uint8_t kSetVariant = 0x3B;
inline constexpr std::uint8_t kRequestMeanSubRange = 0x3F;
inline constexpr std::uint8_t kSetPermanentBaud = 0x66;
inline constexpr std::uint8_t kReadConfiguration = 0x74;
inline constexpr std::uint8_t kWriteConfiguration = 0x77;
inline constexpr std::uint8_t kReadConfiguration2 = 0x7B;
}  // namespace command

namespace response {
inline constexpr std::uint8_t kPowerOn = 0x90;
inline constexpr std::uint8_t kReset = 0x91;
inline constexpr std::uint8_t kRefused = 0x92;
inline constexpr std::uint8_t kMode = 0xA0;
inline constexpr std::uint8_t kScan = 0xB0;
inline constexpr std::uint8_t kStatus = 0xB1;
inline constexpr std::uint8_t kErrors = 0xB2;
inline constexpr std::uint8_t kCounters = 0xB5;
inline constexpr std::uint8_t kMeanScan = 0xB6;
inline constexpr std::uint8_t kSubRange = 0xB7;
inline constexpr std::uint8_t kType = 0xBA;
inline constexpr std::uint8_t kVariant = 0xBB;
inline constexpr std::uint8_t kMeanSubRange = 0xBF;
inline constexpr std::uint8_t kPermanentBaud = 0xE6;
inline constexpr std::uint8_t kConfiguration = 0xF4;
inline constexpr std::uint8_t kReflectivity = 0xF5;
inline constexpr std::uint8_t kConfigurationWritten = 0xF7;
inline constexpr std::uint8_t kConfiguration2 = 0xFB;
}  // namespace response

/// First data byte of 20h.
namespace mode {
inline constexpr std::uint8_t kInstallation = 0x00;
inline constexpr std::uint8_t kDiagnostic = 0x10;
inline constexpr std::uint8_t kStreamAll = 0x24;
inline constexpr std::uint8_t kOnRequest = 0x25;
inline constexpr std::uint8_t kStreamMean = 0x26;
inline constexpr std::uint8_t kStreamSubRange = 0x27;
inline constexpr std::uint8_t kStreamMeanSubRange = 0x28;
inline constexpr std::uint8_t kStreamPartial = 0x2A;
inline constexpr std::uint8_t kStreamReflectivity = 0x2B;
inline constexpr std::uint8_t kTestPassword = 0x30;
inline constexpr std::uint8_t kBaud38400 = 0x40;
inline constexpr std::uint8_t kBaud19200 = 0x41;
inline constexpr std::uint8_t kBaud9600 = 0x42;
inline constexpr std::uint8_t kBaud500000 = 0x48;
}  // namespace mode

inline constexpr std::string_view kPassword = "SICK_LMS";

/// Result bytes. A0h counts from 00, the others from 01 (B3).
inline constexpr std::uint8_t kModeSwitched = 0x00;
inline constexpr std::uint8_t kAccepted = 0x01;

// Requests, whole telegrams.
[[nodiscard]] std::vector<std::uint8_t> reset_request();
[[nodiscard]] std::vector<std::uint8_t> mode_request(std::uint8_t mode);
[[nodiscard]] std::vector<std::uint8_t> installation_request(std::string_view password = kPassword);
/// 9600, 19200, 38400 or 500000.
[[nodiscard]] std::vector<std::uint8_t> baud_request(unsigned baud);
[[nodiscard]] std::vector<std::uint8_t> scan_request();
[[nodiscard]] std::vector<std::uint8_t> status_request();
[[nodiscard]] std::vector<std::uint8_t> errors_request();
[[nodiscard]] std::vector<std::uint8_t> type_request();
[[nodiscard]] std::vector<std::uint8_t> variant_request(const ScanVariant& variant);
[[nodiscard]] std::vector<std::uint8_t> permanent_baud_request(bool on);
[[nodiscard]] std::vector<std::uint8_t> configuration_request();
[[nodiscard]] std::vector<std::uint8_t> write_configuration_request(const Configuration& configuration);

[[nodiscard]] std::optional<std::uint8_t> mode_of_baud(unsigned baud);
[[nodiscard]] std::optional<unsigned> baud_of_mode(std::uint8_t mode);

// What a device reads out of a request.
[[nodiscard]] std::optional<ScanVariant> requested_variant(const Telegram& telegram);
[[nodiscard]] bool has_right_password(const Telegram& telegram);

// Answers, whole telegrams, without the ACK.
[[nodiscard]] std::vector<std::uint8_t> power_on_reply(std::string_view type);
[[nodiscard]] std::vector<std::uint8_t> refused_reply();
[[nodiscard]] std::vector<std::uint8_t> mode_reply(bool switched);
[[nodiscard]] std::vector<std::uint8_t> type_reply(std::string_view type);
[[nodiscard]] std::vector<std::uint8_t> variant_reply(bool accepted, const ScanVariant& active);
/// With the setting that now counts.
[[nodiscard]] std::vector<std::uint8_t> permanent_baud_reply(bool accepted, bool is_permanent);
[[nodiscard]] std::vector<std::uint8_t> configuration_reply(const Configuration& configuration);
/// An LMS200 has nothing to say in it: 84 zeros.
[[nodiscard]] std::vector<std::uint8_t> configuration_2_reply();
[[nodiscard]] std::vector<std::uint8_t> configuration_written_reply(bool accepted, const Configuration& active);

// What a host reads out of an answer; nullopt where it is of another kind or too short.
[[nodiscard]] std::optional<bool> mode_was_switched(const Telegram& telegram);

struct VariantReply {
  bool accepted = false;
  ScanVariant active;
};
[[nodiscard]] std::optional<VariantReply> decoded_variant_reply(const Telegram& telegram);

struct PermanentBaudReply {
  bool accepted = false;
  bool is_permanent = false;
};
/// From E6h.
[[nodiscard]] std::optional<PermanentBaudReply> decoded_permanent_baud_reply(const Telegram& telegram);

/// From F4h.
[[nodiscard]] std::optional<Configuration> decoded_configuration(const Telegram& telegram);

struct WriteReply {
  bool accepted = false;
  Configuration active;
};
/// From F7h.
[[nodiscard]] std::optional<WriteReply> decoded_write_reply(const Telegram& telegram);

/// "all values as a stream", "installation", "38400 baud", ... of a first data byte of 20h; "mode 99" where unknown.
[[nodiscard]] std::string mode_name(std::uint8_t mode);

/// "set mode", "scan", ...; "command 99" where B3 does not list it. For requests and answers.
[[nodiscard]] std::string telegram_name(std::uint8_t command_or_response);

}  // namespace deltamap::drivers::lms200
