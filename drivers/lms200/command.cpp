// SPDX-License-Identifier: Apache-2.0
#include "drivers/lms200/command.hpp"

#include <algorithm>
#include <array>
#include <cassert>

#include "drivers/byte_fields.hpp"

namespace deltamap::drivers::lms200 {
namespace {

struct BaudMode {
  unsigned baud;
  std::uint8_t mode;
};

constexpr auto kBaudModes = std::to_array<BaudMode>({
    {9600, mode::kBaud9600},
    {19200, mode::kBaud19200},
    {38400, mode::kBaud38400},
    {500000, mode::kBaud500000},
});

struct NamedTelegram {
  std::uint8_t code;
  const char* name;
};

constexpr auto kNames = std::to_array<NamedTelegram>({
    {command::kReset, "reset"},
    {command::kSetMode, "set mode"},
    {command::kRequestScan, "request scan"},
    {command::kRequestStatus, "request status"},
    {command::kRequestErrors, "request errors"},
    {command::kRequestCounters, "request counters"},
    {command::kRequestMean, "request mean scan"},
    {command::kRequestSubRange, "request sub-range"},
    {command::kRequestMeanSubRange, "request mean sub-range"},
    {command::kRequestType, "request type"},
    {command::kSetVariant, "set variant"},
    {command::kSetPermanentBaud, "set permanent baud"},
    {command::kReadConfiguration, "read configuration"},
    {command::kWriteConfiguration, "write configuration"},
    {command::kReadConfiguration2, "read configuration 2"},
    {response::kPowerOn, "power-on"},
    {response::kReset, "reset confirmed"},
    {response::kRefused, "refused"},
    {response::kMode, "mode"},
    {response::kScan, "scan"},
    {response::kStatus, "status"},
    {response::kErrors, "errors"},
    {response::kCounters, "counters"},
    {response::kMeanScan, "mean scan"},
    {response::kSubRange, "sub-range"},
    {response::kMeanSubRange, "mean sub-range"},
    {response::kReflectivity, "ranges with reflectivity"},
    {response::kConfiguration2, "configuration 2"},
    {response::kType, "type"},
    {response::kVariant, "variant"},
    {response::kPermanentBaud, "permanent baud"},
    {response::kConfiguration, "configuration"},
    {response::kConfigurationWritten, "configuration written"},
});

constexpr auto kModeNames = std::to_array<NamedTelegram>({
    {mode::kInstallation, "installation"},
    {mode::kDiagnostic, "diagnostic"},
    {mode::kStreamAll, "stream of all values"},
    {mode::kOnRequest, "on request"},
    {mode::kStreamMean, "stream of means"},
    {mode::kStreamSubRange, "stream of a sub-range"},
    {mode::kStreamMeanSubRange, "stream of means of a sub-range"},
    {mode::kStreamPartial, "stream of partial scans"},
    {mode::kStreamReflectivity, "stream of ranges with reflectivity"},
    {mode::kTestPassword, "test of the password"},
    {mode::kBaud38400, "38400 baud"},
    {mode::kBaud19200, "19200 baud"},
    {mode::kBaud9600, "9600 baud"},
    {mode::kBaud500000, "500000 baud"},
});

template <typename Names>
std::string name_in(const Names& names, std::uint8_t code, const char* unnamed) {
  const auto* found =
      std::find_if(names.begin(), names.end(), [&](const NamedTelegram& named) { return named.code == code; });
  return found != names.end() ? found->name : unnamed + std::to_string(code);
}

std::vector<std::uint8_t> request(std::uint8_t code, const FieldWriter& data = {}) {
  return encoded_request(code, data.written());
}

std::vector<std::uint8_t> reply(std::uint8_t code, const FieldWriter& data = {}) {
  return encoded_reply(code, data.written());
}

/// The fields of an answer of one kind; nullopt for any other telegram.
std::optional<FieldReader> fields_of(const Telegram& telegram, std::uint8_t code) {
  if (telegram.kind != Telegram::Kind::kTelegram || telegram.command != code) return std::nullopt;
  return FieldReader{telegram.data};
}

}  // namespace

std::vector<std::uint8_t> reset_request() { return request(command::kReset); }

std::vector<std::uint8_t> mode_request(std::uint8_t wanted) {
  return request(command::kSetMode, FieldWriter{}.u8(wanted));
}

std::vector<std::uint8_t> installation_request(std::string_view password) {
  return request(command::kSetMode, FieldWriter{}.u8(mode::kInstallation).text(password));
}

std::vector<std::uint8_t> baud_request(unsigned baud) {
  const std::optional<std::uint8_t> wanted = mode_of_baud(baud);
  assert(wanted && "the laser knows four speeds");
  return mode_request(wanted.value_or(mode::kBaud9600));
}

std::vector<std::uint8_t> scan_request() { return request(command::kRequestScan, FieldWriter{}.u8(1)); }
std::vector<std::uint8_t> status_request() { return request(command::kRequestStatus); }
std::vector<std::uint8_t> errors_request() { return request(command::kRequestErrors); }
std::vector<std::uint8_t> type_request() { return request(command::kRequestType); }

std::vector<std::uint8_t> variant_request(const ScanVariant& variant) {
  return request(command::kSetVariant, FieldWriter{}.u16(variant.angle_deg).u16(variant.resolution_centideg));
}

std::vector<std::uint8_t> permanent_baud_request(bool on) {
  return request(command::kSetPermanentBaud, FieldWriter{}.u8(on ? 1 : 0));
}

std::vector<std::uint8_t> configuration_request() { return request(command::kReadConfiguration); }

std::vector<std::uint8_t> write_configuration_request(const Configuration& configuration) {
  return request(command::kWriteConfiguration, FieldWriter{}.bytes(configuration.bytes));
}

std::optional<std::uint8_t> mode_of_baud(unsigned baud) {
  const auto* found =
      std::find_if(kBaudModes.begin(), kBaudModes.end(), [&](const BaudMode& b) { return b.baud == baud; });
  return found != kBaudModes.end() ? std::optional{found->mode} : std::nullopt;
}

std::optional<unsigned> baud_of_mode(std::uint8_t wanted) {
  const auto* found =
      std::find_if(kBaudModes.begin(), kBaudModes.end(), [&](const BaudMode& b) { return b.mode == wanted; });
  return found != kBaudModes.end() ? std::optional{found->baud} : std::nullopt;
}

std::optional<ScanVariant> requested_variant(const Telegram& telegram) {
  std::optional<FieldReader> fields = fields_of(telegram, command::kSetVariant);
  if (!fields) return std::nullopt;
  ScanVariant variant;
  variant.angle_deg = fields->u16();
  variant.resolution_centideg = fields->u16();
  return fields->is_good() ? std::optional{variant} : std::nullopt;
}

bool has_right_password(const Telegram& telegram) {
  return telegram.data.size() == kPassword.size() + 1 &&
         std::equal(kPassword.begin(), kPassword.end(), telegram.data.begin() + 1,
                    [](char letter, std::uint8_t byte) { return static_cast<std::uint8_t>(letter) == byte; });
}

std::vector<std::uint8_t> power_on_reply(std::string_view type) {
  return reply(response::kPowerOn, FieldWriter{}.text(type));
}

std::vector<std::uint8_t> refused_reply() { return reply(response::kRefused); }

std::vector<std::uint8_t> mode_reply(bool switched) {
  return reply(response::kMode, FieldWriter{}.u8(switched ? kModeSwitched : 1));
}

std::vector<std::uint8_t> type_reply(std::string_view type) { return reply(response::kType, FieldWriter{}.text(type)); }

std::vector<std::uint8_t> variant_reply(bool accepted, const ScanVariant& active) {
  return reply(response::kVariant,
               FieldWriter{}.u8(accepted ? kAccepted : 0).u16(active.angle_deg).u16(active.resolution_centideg));
}

std::vector<std::uint8_t> permanent_baud_reply(bool accepted, bool is_permanent) {
  return reply(response::kPermanentBaud, FieldWriter{}.u8(accepted ? kAccepted : 0).u8(is_permanent ? 1 : 0));
}

std::vector<std::uint8_t> configuration_2_reply() {
  constexpr std::size_t kSize = 84;
  return reply(response::kConfiguration2, FieldWriter{}.bytes(std::vector<std::uint8_t>(kSize, 0)));
}

std::vector<std::uint8_t> configuration_reply(const Configuration& configuration) {
  return reply(response::kConfiguration, FieldWriter{}.bytes(configuration.bytes));
}

std::vector<std::uint8_t> configuration_written_reply(bool accepted, const Configuration& active) {
  return reply(response::kConfigurationWritten, FieldWriter{}.u8(accepted ? kAccepted : 0).bytes(active.bytes));
}

std::optional<bool> mode_was_switched(const Telegram& telegram) {
  std::optional<FieldReader> fields = fields_of(telegram, response::kMode);
  if (!fields || fields->left() < 1) return std::nullopt;
  return fields->u8() == kModeSwitched;
}

std::optional<VariantReply> decoded_variant_reply(const Telegram& telegram) {
  std::optional<FieldReader> fields = fields_of(telegram, response::kVariant);
  if (!fields) return std::nullopt;
  VariantReply answer;
  answer.accepted = fields->u8() == kAccepted;
  answer.active.angle_deg = fields->u16();
  answer.active.resolution_centideg = fields->u16();
  return fields->is_good() ? std::optional{answer} : std::nullopt;
}

std::optional<PermanentBaudReply> decoded_permanent_baud_reply(const Telegram& telegram) {
  std::optional<FieldReader> fields = fields_of(telegram, response::kPermanentBaud);
  if (!fields) return std::nullopt;
  PermanentBaudReply answer;
  answer.accepted = fields->u8() == kAccepted;
  answer.is_permanent = fields->u8() == 1;
  return fields->is_good() ? std::optional{answer} : std::nullopt;
}

std::optional<Configuration> decoded_configuration(const Telegram& telegram) {
  if (telegram.kind != Telegram::Kind::kTelegram || telegram.command != response::kConfiguration) return std::nullopt;
  if (telegram.data.size() < Configuration::kSize) return std::nullopt;
  return configuration_with(std::span{telegram.data}.first(Configuration::kSize), {});
}

std::optional<WriteReply> decoded_write_reply(const Telegram& telegram) {
  if (telegram.kind != Telegram::Kind::kTelegram || telegram.command != response::kConfigurationWritten) {
    return std::nullopt;
  }
  if (telegram.data.size() < Configuration::kSize + 1) return std::nullopt;
  const auto active = configuration_with(std::span{telegram.data}.subspan(1, Configuration::kSize), {});
  return WriteReply{telegram.data[0] == kAccepted, *active};
}

std::string mode_name(std::uint8_t mode) { return name_in(kModeNames, mode, "mode "); }

std::string telegram_name(std::uint8_t code) { return name_in(kNames, code, "command "); }

}  // namespace deltamap::drivers::lms200
