// SPDX-License-Identifier: Apache-2.0
// Notices that a line damages what a device sends again and again while it works: what is wrong then never becomes
// data, and nobody would learn why scans and packets are missing. Sessions feed it what their decoder has counted.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "core/time.hpp"
#include "drivers/decoder_counts.hpp"
#include "drivers/line_diagnosis.hpp"

namespace deltamap::drivers {

class LineQuality {
 public:
  explicit LineQuality(Device device) : device_{device} {}

  struct Change {
    bool is_disturbed = false;
    std::string line;  ///< for the operator
  };
  /// After each chunk of a device that works. Damage counts once between two good frames: three times in 5 s is too
  /// much, 10 s without any is well again.
  [[nodiscard]] std::optional<Change> observe(const DecoderCounts& counts, Timestamp now);
  /// The device does not work: what comes is for LineDiagnosis.
  void forget() { seen_.reset(); }

 private:
  [[nodiscard]] Change told(std::string_view what) const;

  Device device_;
  std::optional<DecoderCounts> seen_;  // at the last look
  std::uint64_t frames_at_damage_ = 0;
  Timestamp first_damage_;  // of those that count
  Timestamp last_damage_;
  int damages_ = 0;
  bool is_disturbed_ = false;
};

}  // namespace deltamap::drivers
