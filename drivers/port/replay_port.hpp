// SPDX-License-Identifier: Apache-2.0
// The two ports of a recording, played back: what came in, and the notes, in the recorded order. What went out is left
// out: sessions only listen in a replay.
#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <utility>

#include "drivers/port/byte_log.hpp"
#include "drivers/port/passed_time.hpp"

namespace deltamap::drivers::port {

/// Which part of the recording counts, in seconds after its first record.
struct ReplayWindow {
  double from_s = 0.0;
  double to_s = std::numeric_limits<double>::infinity();
};

struct ReplayedRecord {
  ByteRecord record;
  /// False before the window: feed the sessions, so that they learn what the devices said at their start, and drop the
  /// messages that they decode.
  bool in_window = true;
};

class ReplayPort {
 public:
  /// Throws std::runtime_error as ByteLogReader does.
  ReplayPort(std::filesystem::path file, const ReplayWindow& window)
      : file_{std::move(file)}, reader_{file_}, window_{window} {}

  /// The next record; nothing at the end, after the window, or where the file was cut. Throws as ByteLogReader does.
  [[nodiscard]] std::optional<ReplayedRecord> next();

  /// Of what has been read; a clock that was set back is one of the doubts.
  [[nodiscard]] LogFaults faults() const;
  /// Packets that were read before the window.
  [[nodiscard]] std::uint64_t packets_before() const { return packets_before_; }
  /// Reads on to the end: packets after the window, that which ended it included. Throws as ByteLogReader does.
  [[nodiscard]] std::uint64_t count_packets_after();
  [[nodiscard]] std::uint64_t size_bytes() const { return reader_.size_bytes(); }
  [[nodiscard]] std::uint64_t read_bytes() const { return reader_.read_bytes(); }

 private:
  void note_clock(double after_s);

  std::filesystem::path file_;
  ByteLogReader reader_;
  ReplayWindow window_;
  bool is_over_ = false;
  std::uint64_t packets_before_ = 0;
  std::uint64_t set_back_ = 0;     // times that the clock was
  double first_set_back_s_ = 0.0;  // after the first record
  double farthest_back_s_ = 0.0;
  PassedTime passed_;
};

}  // namespace deltamap::drivers::port
