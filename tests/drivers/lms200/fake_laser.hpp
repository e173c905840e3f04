// SPDX-License-Identifier: Apache-2.0
// A scripted laser for session tests: answers as the listing says, may miss, refuse or mangle what it is told, and
// streams scans at line rate (protocols.md B1, B3, B7).
#pragma once

#include <string>
#include <vector>

#include "drivers/lms200/command.hpp"
#include "drivers/lms200/configuration.hpp"
#include "drivers/lms200/measurement.hpp"
#include "drivers/lms200/status.hpp"
#include "drivers/lms200/telegram.hpp"
#include "tests/support/bytes/conversation.hpp"

namespace deltamap::drivers::lms200 {

class FakeLaser {
 public:
  explicit FakeLaser(unsigned baud) : decoder_{Sender::kHost, baud} {}

  [[nodiscard]] unsigned baud() const { return decoder_.baud(); }

  void take(const std::vector<std::uint8_t>& bytes, Timestamp now) {
    for (const Telegram& telegram : decoder_.decode(bytes, now)) {
      if (now < silent_until || requests_to_miss-- > 0) continue;
      requests_to_miss = 0;
      const Timestamp is_here = now + line_time(bytes.size(), baud());
      if (nak_from_request-- <= 0 && naks_to_send-- > 0) {
        send({kNakByte}, is_here);
        continue;
      }
      heard.push_back(telegram);
      if (!loses_acks) send({kAckByte}, is_here);
      obey(telegram, is_here);
    }
  }

  void tick(Timestamp now) {
    if (new_baud_ && now >= new_baud_at_) {
      decoder_.set_baud(*new_baud_);
      new_baud_.reset();
    }
    if (power_on_at && now >= *power_on_at) {
      power_on_at.reset();
      is_streaming = false;
      variant = {180, 100};
      decoder_.set_baud(9600);
      outgoing.clear();
      send(power_on_reply("LMS200;301063;V02.10 "), now);
    }
    if (!is_streaming || now < silent_until || line_free_ > now) return;
    Measurement measurement;
    measurement.words.assign(variant.values(), 1500);
    measurement.unit_code = static_cast<std::uint8_t>(configuration.units());
    send(encoded_measurement(measurement), now);
  }

  ScanVariant variant{180, 100};
  Configuration configuration = in_centimetres();
  bool is_streaming = false;
  bool loses_acks = false;
  bool refuses_variant = false;
  bool refuses_password = false;
  bool refuses_write = false;
  bool refuses_baud = false;
  bool loses_baud_answer = false;
  int requests_to_miss = 0;
  int nak_from_request = 0;  // counted from now
  int naks_to_send = 0;
  Timestamp silent_until = Timestamp::min();
  std::optional<Timestamp> power_on_at;
  std::vector<Telegram> heard;
  std::vector<tests::SentBytes> outgoing;
  int writes = 0;

 private:
  static Configuration in_centimetres() {
    Configuration configuration;
    configuration.set_units(Units::kCentimetre);
    return configuration;
  }

  void obey(const Telegram& telegram, Timestamp now) {
    switch (telegram.command) {
      case command::kSetMode:
        set_mode(telegram, now);
        break;
      case command::kRequestStatus:
        send(status_reply(status()), now);
        break;
      case command::kSetVariant:
        if (!refuses_variant) variant = requested_variant(telegram).value();
        send(variant_reply(!refuses_variant, variant), now + std::chrono::milliseconds{300});
        break;
      case command::kReadConfiguration:
        send(configuration_reply(configuration), now);
        break;
      case command::kWriteConfiguration:
        if (!refuses_write) {
          ++writes;
          configuration = configuration_with(telegram.data, configuration).value();
        }
        send(configuration_written_reply(!refuses_write, configuration), now + std::chrono::milliseconds{300});
        break;
      default:
        send(refused_reply(), now);
    }
  }

  void set_mode(const Telegram& telegram, Timestamp now) {
    const std::uint8_t wanted = telegram.data.at(0);
    if (wanted == mode::kInstallation) {
      send(mode_reply(has_right_password(telegram) && !refuses_password), now + std::chrono::milliseconds{80});
      return;
    }
    const std::optional<unsigned> speed = baud_of_mode(wanted);
    const bool agrees = !(speed && refuses_baud);
    if (wanted == mode::kOnRequest && is_streaming) {
      // A running output is interrupted in the middle of a telegram.
      outgoing.clear();
      line_free_ = now;
      is_streaming = false;
      send({0x02, 0x80, 0xD6, 0x02, 0xB0, 0x69, 0x41, 0xDC, 0x05}, now);
      send({kAckByte}, now);
    }
    if (!(speed && loses_baud_answer)) send(mode_reply(agrees), now);
    if (speed && agrees) {
      new_baud_ = speed;
      new_baud_at_ = line_free_ + std::chrono::milliseconds{3};
      silent_until = line_free_ + std::chrono::milliseconds{400};
    }
    is_streaming = wanted == mode::kStreamAll;
  }

  [[nodiscard]] DeviceStatus status() const {
    DeviceStatus status;
    status.operating_mode = is_streaming ? mode::kStreamAll : mode::kOnRequest;
    status.measuring_mode = configuration.measuring_mode();
    status.scan_angle_deg = variant.angle_deg;
    status.resolution_centideg = variant.resolution_centideg;
    status.units = static_cast<std::uint8_t>(configuration.units());
    status.baud_code = *baud_code(baud());
    return status;
  }

  void send(std::vector<std::uint8_t> bytes, Timestamp now) {
    const Timestamp begin = std::max(now, line_free_);
    line_free_ = begin + line_time(bytes.size(), baud());
    outgoing.push_back({line_free_, std::move(bytes)});
  }

  TelegramDecoder decoder_;
  Timestamp line_free_;
  std::optional<unsigned> new_baud_;
  Timestamp new_baud_at_;
};

}  // namespace deltamap::drivers::lms200
