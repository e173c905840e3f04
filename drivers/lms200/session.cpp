// SPDX-License-Identifier: Apache-2.0
// What comes in, in both modes: what the laser says about itself, and scans. The conversation is in session_setup.cpp.
#include "drivers/lms200/session.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace deltamap::drivers::lms200 {
namespace {

unsigned known_baud_or_throw(unsigned baud) {
  if (!mode_of_baud(baud)) {
    throw std::invalid_argument("laser baud " + std::to_string(baud) + " is unknown: 9600, 19200, 38400 or 500000");
  }
  return baud;
}

}  // namespace

Lms200Session::Lms200Session(const Lms200Params& params, SessionMode mode)
    : params_{params},
      mode_{mode},
      decoder_{Sender::kDevice, known_baud_or_throw(params.baud)},
      home_baud_{params.baud} {
  if (!is_possible(params.variant)) {
    throw std::invalid_argument("laser variant " + name_of(params.variant) +
                                " is unknown: 180/1, 180/0.5, 100/1, 100/0.5 or 100/0.25");
  }
  if (params.measuring_mode && !range_coding(*params.measuring_mode)) {
    throw std::invalid_argument("laser measuring mode " + std::to_string(*params.measuring_mode) + " has no ranges");
  }
}

Lms200Output Lms200Session::on_bytes(std::span<const std::uint8_t> bytes, Timestamp stamp) {
  Lms200Output out;
  const std::uint64_t errors_before = decoder_.counts().errors();
  const std::vector<Telegram> telegrams = decoder_.decode(bytes, stamp);
  for (const Telegram& telegram : telegrams) {
    take_telegram(telegram, out);
    if (mode_ == SessionMode::kLive && state_ != State::kIdle) answer(telegram, stamp, out);
  }
  if (telegrams.empty()) {
    take_no_telegram(decoder_.counts().errors() > errors_before, stamp);
    if (mode_ == SessionMode::kLive && state_ != State::kStreaming) diagnose(bytes, out);
  }
  return finished(std::move(out));
}

void Lms200Session::on_baud(unsigned baud) {
  was_told_baud_ = true;
  decoder_.set_baud(baud);
}

void Lms200Session::take_telegram(const Telegram& telegram, Lms200Output& out) {
  if (telegram.kind != Telegram::Kind::kTelegram) return;
  diagnosis_.hear_own_frame();
  switch (telegram.command) {
    case response::kScan:
      take_scan(telegram, out);
      break;
    case response::kStatus:
      take_status(telegram, out);
      break;
    case response::kPowerOn:
      out.output.log.push_back("laser has started up");
      forget();
      break;
    case response::kVariant:
      if (const auto reply = decoded_variant_reply(telegram)) known_variant_ = reply->active;
      break;
    case response::kConfiguration:
      if (const auto configuration = decoded_configuration(telegram)) {
        known_configuration_ = configuration;
        known_mode_ = configuration->measuring_mode();
      } else {
        ++content_counts_.malformed;
      }
      break;
    case response::kConfigurationWritten:
      if (const auto reply = decoded_write_reply(telegram)) {
        known_configuration_ = reply->active;
        known_mode_ = reply->active.measuring_mode();
      } else {
        ++content_counts_.malformed;
      }
      break;
    case response::kMode:
    case response::kRefused:
    case response::kType:
      break;
    default:
      ++content_counts_.unknown;
  }
}

void Lms200Session::take_status(const Telegram& telegram, Lms200Output& out) {
  const std::optional<DeviceStatus> status = decoded_status(telegram);
  if (!status) {
    ++content_counts_.malformed;
    return;
  }
  known_mode_ = status->measuring_mode;
  known_variant_ = ScanVariant{status->scan_angle_deg, status->resolution_centideg};
  if (status->fault != 0) out.output.log.push_back("laser reports fault=" + std::to_string(status->fault));
  const std::optional<unsigned> line_baud = status->baud();
  if (mode_ == SessionMode::kListenOnly && !was_told_baud_ && line_baud) decoder_.set_baud(*line_baud);
}

void Lms200Session::forget() {
  known_mode_.reset();
  known_variant_.reset();
  known_configuration_.reset();
  first_scan_without_mode_.reset();
}

void Lms200Session::take_scan(const Telegram& telegram, Lms200Output& out) {
  const std::optional<Measurement> measurement = decoded_measurement(telegram);
  if (!measurement) {
    ++content_counts_.malformed;
    return;
  }
  constexpr std::uint8_t kHealthBits = kSeverityBits | kImplausibleBit | kDirtyWindowBit;
  const auto health = static_cast<std::uint8_t>(measurement->status & kHealthBits);
  if (health != scan_health_) {
    scan_health_ = health;
    out.output.log.push_back("laser status severity=" + std::to_string(health & kSeverityBits) +
                             ((health & kImplausibleBit) != 0 ? " values=implausible" : "") +
                             ((health & kDirtyWindowBit) != 0 ? " window=dirty" : ""));
  }
  const std::optional<std::uint8_t> measured_in = measuring_mode(telegram.received);
  if (!measured_in) return;
  const ScanFormat format{*measured_in, params_.max_range_m, params_.robot_from_laser};
  std::optional<Scan> scan = scan_from(*measurement, format, telegram.first_byte, telegram.received);
  if (!scan) {
    ++content_counts_.malformed;
    return;
  }
  scan->time = scan_times_.next(scan->time, scan->received);
  scan->number = next_scan_number_++;
  out.scans.push_back(std::move(*scan));
}

/// Unknown until the laser has told it: a wrong mask makes wrong ranges. A recording may never tell.
std::optional<std::uint8_t> Lms200Session::measuring_mode(Timestamp now) {
  if (known_mode_ || mode_ == SessionMode::kLive) return known_mode_;
  if (!first_scan_without_mode_) first_scan_without_mode_ = now;
  if (now - *first_scan_without_mode_ < duration_from_seconds(params_.assume_after_s)) return std::nullopt;
  return wanted_configuration().measuring_mode();
}

Configuration Lms200Session::wanted_configuration() const {
  Configuration wanted = known_configuration_.value_or(Configuration{});
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

DecoderCounts Lms200Session::counts() const {
  DecoderCounts counts = decoder_.counts();
  counts.malformed += content_counts_.malformed;
  counts.unknown += content_counts_.unknown;
  return counts;
}

double Lms200Session::nominal_period_s() const {
  constexpr std::size_t kBytesAroundWords = 10;  // B6
  const ScanVariant variant = known_variant_ && is_possible(*known_variant_) ? *known_variant_ : params_.variant;
  const double line_s = seconds(line_time(2 * variant.values() + kBytesAroundWords, baud()));
  return std::ceil(line_s / variant.scan_duration_s()) * variant.scan_duration_s();
}

}  // namespace deltamap::drivers::lms200
