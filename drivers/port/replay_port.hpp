// SPDX-License-Identifier: Apache-2.0
// The two ports of a recording, played back: what came in, and the notes, in the recorded order. What went out is left
// out: sessions only listen in a replay.
#pragma once

#include <filesystem>
#include <limits>
#include <optional>

#include "drivers/port/byte_log.hpp"

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
  ReplayPort(const std::filesystem::path& file, const ReplayWindow& window) : reader_{file}, window_{window} {}

  /// The next record; nothing at the end, after the window, or where the file was cut. Throws as ByteLogReader does.
  [[nodiscard]] std::optional<ReplayedRecord> next();

  [[nodiscard]] LogFaults faults() const { return reader_.faults(); }
  [[nodiscard]] std::uint64_t size_bytes() const { return reader_.size_bytes(); }
  [[nodiscard]] std::uint64_t read_bytes() const { return reader_.read_bytes(); }

 private:
  ByteLogReader reader_;
  ReplayWindow window_;
  std::optional<Timestamp> began_;  // on the clock as it is set now
  Timestamp last_{};
};

}  // namespace deltamap::drivers::port
