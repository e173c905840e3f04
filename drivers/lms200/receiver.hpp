// SPDX-License-Identifier: Apache-2.0
// What comes from an LMS200, live or in a recording: takes bytes, answers telegrams, numbered scans with their times,
// and what the laser has said about itself (protocols.md B1, B4 to B7). Knows nothing of the conversation: it never
// asks for anything.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/messages.hpp"
#include "core/time.hpp"
#include "drivers/decoder_counts.hpp"
#include "drivers/lms200/params.hpp"
#include "drivers/lms200/telegram.hpp"
#include "drivers/monotonic_times.hpp"
#include "drivers/session.hpp"

namespace deltamap::drivers::lms200 {

class Receiver {
 public:
  Receiver(const Lms200Params& params, SessionMode mode);

  struct Chunk {
    std::vector<Telegram> telegrams;
    bool has_garbage = false;
  };
  [[nodiscard]] Chunk decode(std::span<const std::uint8_t> bytes, Timestamp stamp);

  struct Content {
    std::optional<Scan> scan;
    std::vector<std::string> log;
    std::vector<std::string> warnings;
  };
  /// Reads what a telegram says. Each is taken once, before the next is.
  [[nodiscard]] Content take(const Telegram& telegram);

  /// The line has changed its speed. In a recording that says so itself, the status does not tell it any more.
  void set_baud(unsigned baud, bool by_recording = false);
  /// Whoever is on the line now may measure in another mode: no scan before its status.
  void forget_mode() { mode_.reset(); }

  // What the laser has said about itself since it was started up.
  [[nodiscard]] const std::optional<std::uint8_t>& measuring_mode() const { return mode_; }
  [[nodiscard]] const std::optional<ScanVariant>& variant() const { return variant_; }
  [[nodiscard]] const std::optional<Configuration>& configuration() const { return configuration_; }
  /// That configuration, with units and measuring mode as wanted.
  [[nodiscard]] Configuration wanted_configuration() const;

  [[nodiscard]] unsigned baud() const { return decoder_.baud(); }
  [[nodiscard]] std::size_t awaited_bytes() const { return decoder_.awaited_bytes(); }
  [[nodiscard]] DecoderCounts counts() const;
  /// Time from one scan to the next at this variant and baud (B7).
  [[nodiscard]] double nominal_period_s() const;

 private:
  void take_status(const Telegram& telegram, Content& content);
  void take_variant(const ScanVariant& variant, Content& content);
  void take_configuration(const std::optional<Configuration>& configuration);
  void take_scan(const Telegram& telegram, Content& content);
  void ignore_beams(Scan& scan) const;
  void take_health(std::uint8_t status, Content& content);
  void forget();
  [[nodiscard]] std::optional<std::uint8_t> mode_of_scan(Timestamp received);

  Lms200Params params_;
  bool is_recording_;
  bool was_told_baud_ = false;  // by the recording
  TelegramDecoder decoder_;
  DecoderCounts content_counts_;  // malformed and unknown, on top of the decoder's own
  std::uint32_t next_scan_number_ = 0;
  MonotonicTimes scan_times_;
  std::optional<std::uint8_t> mode_;
  std::optional<ScanVariant> variant_;
  std::optional<Configuration> configuration_;
  std::optional<Timestamp> first_scan_without_mode_;
  std::uint8_t scan_health_ = 0;  // of the newest scan
};

}  // namespace deltamap::drivers::lms200
