// SPDX-License-Identifier: Apache-2.0
#include "drivers/lms200/receiver.hpp"

#include <cmath>
#include <utility>

#include "drivers/lms200/command.hpp"
#include "drivers/lms200/measurement.hpp"
#include "drivers/lms200/status.hpp"

namespace deltamap::drivers::lms200 {

Receiver::Receiver(const Lms200Params& params, SessionMode mode)
    : params_{params}, is_recording_{mode == SessionMode::kListenOnly}, decoder_{Sender::kDevice, params.baud} {}

Receiver::Chunk Receiver::decode(std::span<const std::uint8_t> bytes, Timestamp stamp) {
  const std::uint64_t errors_before = decoder_.counts().errors();
  std::vector<Telegram> telegrams = decoder_.decode(bytes, stamp);
  return {std::move(telegrams), decoder_.counts().errors() > errors_before};
}

void Receiver::set_baud(unsigned baud, bool by_recording) {
  was_told_baud_ = was_told_baud_ || by_recording;
  decoder_.set_baud(baud);
}

Receiver::Content Receiver::take(const Telegram& telegram) {
  Content content;
  if (telegram.kind != Telegram::Kind::kTelegram) return content;
  switch (telegram.command) {
    case response::kScan:
      take_scan(telegram, content);
      break;
    case response::kStatus:
      take_status(telegram, content);
      break;
    case response::kPowerOn:
      content.log.emplace_back("laser has started up");
      forget();
      break;
    case response::kVariant:
      if (const auto reply = decoded_variant_reply(telegram)) take_variant(reply->active, content);
      break;
    case response::kConfiguration:
      take_configuration(decoded_configuration(telegram));
      break;
    case response::kConfigurationWritten: {
      const std::optional<WriteReply> reply = decoded_write_reply(telegram);
      take_configuration(reply ? std::optional{reply->active} : std::nullopt);
      break;
    }
    case response::kMode:
    case response::kRefused:
    case response::kType:
      break;
    default:
      ++content_counts_.unknown;
  }
  return content;
}

void Receiver::take_status(const Telegram& telegram, Content& content) {
  const std::optional<DeviceStatus> status = decoded_status(telegram);
  if (!status) {
    ++content_counts_.malformed;
    return;
  }
  mode_ = status->measuring_mode;
  take_variant({status->scan_angle_deg, status->resolution_centideg}, content);
  if (status->fault != 0) content.log.push_back("laser reports fault=" + std::to_string(status->fault));
  const std::optional<unsigned> line_baud = status->baud();
  if (is_recording_ && !was_told_baud_ && line_baud) decoder_.set_baud(*line_baud);
}

/// Values of a fan that nobody knows would be drawn where nothing is.
void Receiver::take_variant(const ScanVariant& variant, Content& content) {
  if (variant_ == variant) return;
  variant_ = variant;
  if (is_possible(variant)) return;
  content.warnings.push_back("laser tells variant=" + name_of(variant) +
                             ", which is not known here: its scans are left out; set it to one of laser.variant");
}

void Receiver::take_configuration(const std::optional<Configuration>& configuration) {
  if (!configuration) {
    ++content_counts_.malformed;
    return;
  }
  configuration_ = configuration;
  mode_ = configuration->measuring_mode();
}

void Receiver::take_scan(const Telegram& telegram, Content& content) {
  const std::optional<Measurement> measurement = decoded_measurement(telegram);
  if (!measurement) {
    ++content_counts_.malformed;
    return;
  }
  take_health(measurement->status, content);
  const std::optional<std::uint8_t> measured_in = mode_of_scan(telegram.received);
  if (!measured_in || (variant_ && !is_possible(*variant_))) return;
  const ScanFormat format{*measured_in, params_.max_range_m, params_.robot_from_laser, params_.is_upside_down,
                          variant_.value_or(params_.variant)};
  content.scan = scan_from(*measurement, format, telegram.first_byte, telegram.received);
  if (!content.scan) {
    ++content_counts_.malformed;
    return;
  }
  ignore_beams(*content.scan);
  content.scan->time = scan_times_.next(content.scan->time, content.scan->received);
  content.scan->number = next_scan_number_++;
}

/// What stands on the robot is no obstacle, no wall and no evidence, nor is anything seen behind it.
void Receiver::ignore_beams(Scan& scan) const {
  constexpr double kRounding_rad = 1e-9;
  for (const BearingRange& range : params_.ignored) {
    for (std::size_t i = 0; i < scan.beams.size(); ++i) {
      const double bearing_rad = scan.bearing_rad(i);
      if (bearing_rad < range.from_rad - kRounding_rad || bearing_rad > range.to_rad + kRounding_rad) continue;
      scan.beams[i].kind = BeamKind::kNotValid;
      scan.beams[i].range_m = 0.0F;
    }
  }
}

void Receiver::take_health(std::uint8_t status, Content& content) {
  constexpr std::uint8_t kHealthBits = kSeverityBits | kImplausibleBit | kDirtyWindowBit;
  const auto health = static_cast<std::uint8_t>(status & kHealthBits);
  if (health == scan_health_) return;
  scan_health_ = health;
  content.log.push_back("laser status severity=" + std::to_string(health & kSeverityBits) +
                        ((health & kImplausibleBit) != 0 ? " values=implausible" : "") +
                        ((health & kDirtyWindowBit) != 0 ? " window=dirty" : ""));
}

void Receiver::forget() {
  mode_.reset();
  variant_.reset();
  configuration_.reset();
  first_scan_without_mode_.reset();
}

/// Unknown until the laser has told it: a wrong mask makes wrong ranges. A recording may never tell.
std::optional<std::uint8_t> Receiver::mode_of_scan(Timestamp received) {
  if (mode_ || !is_recording_) return mode_;
  if (!first_scan_without_mode_) first_scan_without_mode_ = received;
  if (received - *first_scan_without_mode_ < duration_from_seconds(params_.assume_after_s)) return std::nullopt;
  return wanted_configuration().measuring_mode();
}

Configuration Receiver::wanted_configuration() const {
  Configuration wanted = configuration_.value_or(Configuration{});
  wanted.set_units(params_.units);
  if (params_.measuring_mode) {
    wanted.set_measuring_mode(*params_.measuring_mode);
    return wanted;
  }
  constexpr std::uint8_t kLongRange = 0x06;
  const double metres_per_word = params_.units == Units::kMillimetre ? 0.001 : 0.01;
  const std::optional<RangeCoding> coding = range_coding(wanted.measuring_mode());
  const bool reaches = coding && coding->beyond_maximum * metres_per_word >= params_.max_range_m;
  if (!reaches) wanted.set_measuring_mode(kLongRange);
  return wanted;
}

DecoderCounts Receiver::counts() const {
  DecoderCounts counts = decoder_.counts();
  counts.malformed += content_counts_.malformed;
  counts.unknown += content_counts_.unknown;
  return counts;
}

double Receiver::nominal_period_s() const {
  constexpr std::size_t kBytesAroundWords = 10;  // B6
  const ScanVariant variant = variant_ && is_possible(*variant_) ? *variant_ : params_.variant;
  const double line_s = seconds(line_time(std::size_t{2} * variant.values() + kBytesAroundWords, baud()));
  return std::ceil(line_s / variant.scan_duration_s()) * variant.scan_duration_s();
}

}  // namespace deltamap::drivers::lms200
