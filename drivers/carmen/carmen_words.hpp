// SPDX-License-Identifier: Apache-2.0
// Which words an LMS200 would have sent for the ranges of a CARMEN log, and which of those ranges are no return
// (docs/protocols/README.md, CARMEN logs; the codes are those of protocols.md B4).
#pragma once

#include <cstdint>
#include <optional>

#include "drivers/carmen/carmen_log.hpp"
#include "drivers/carmen/carmen_survey.hpp"

namespace deltamap::drivers::carmen {

/// One of the codes that an LMS200 sends in place of a range, in any measuring mode (B4).
[[nodiscard]] bool is_scanner_code(std::int64_t word);

class CarmenWords {
 public:
  CarmenWords(const CarmenScan& scan, const CarmenSurvey& survey);

  /// Rounded to the log's unit; a code of the measuring mode where it is no return: the log's own one bit for bit.
  [[nodiscard]] std::uint16_t encoded(double range_m) const;
  [[nodiscard]] bool is_range(double range_m) const { return encoded(range_m) < first_code_; }
  /// The word for a bearing that was not measured, …FFh.
  [[nodiscard]] std::uint16_t not_valid() const;

 private:
  [[nodiscard]] std::int64_t rounded(double range_m) const;
  [[nodiscard]] std::uint16_t code(std::int64_t after_first) const;

  double words_per_m_;
  std::int64_t first_code_;
  std::optional<std::int64_t> no_return_;
  std::optional<std::int64_t> stated_maximum_;
};

}  // namespace deltamap::drivers::carmen
