// SPDX-License-Identifier: Apache-2.0
#include "drivers/carmen/carmen_words.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "drivers/lms200/configuration.hpp"

namespace deltamap::drivers::carmen {
namespace {

constexpr std::array<std::int64_t, 3> kFirstCodes{0x1FF7, 0x3FF7, 0x7FF7};
constexpr std::int64_t kCodes = 9;          // codes of a scanner, x..F7 to x..FF
constexpr std::int64_t kBeyondMaximum = 0;  // counted from the first code, x..F7
constexpr std::int64_t kNotValid = 8;
constexpr double kMostWords = 1e9;  // far beyond any code: keeps the rounding defined

}  // namespace

bool is_scanner_code(std::int64_t word) {
  return std::any_of(kFirstCodes.begin(), kFirstCodes.end(),
                     [&](std::int64_t first) { return word >= first && word < first + kCodes; });
}

CarmenWords::CarmenWords(const CarmenScan& scan, const CarmenSurvey& survey)
    : words_per_m_{survey.units == drivers::lms200::Units::kCentimetre ? 100.0 : 1000.0},
      first_code_{drivers::lms200::range_coding(survey.measuring_mode).value().beyond_maximum} {
  if (survey.no_return_m) no_return_ = rounded(*survey.no_return_m);
  if (scan.stated_max_range_m) stated_maximum_ = rounded(*scan.stated_max_range_m);
}

std::int64_t CarmenWords::rounded(double range_m) const {
  return std::llround(std::min(range_m * words_per_m_, kMostWords));
}

std::uint16_t CarmenWords::code(std::int64_t after_first) const {
  return static_cast<std::uint16_t>(first_code_ + after_first);
}

std::uint16_t CarmenWords::not_valid() const { return code(kNotValid); }

std::uint16_t CarmenWords::encoded(double range_m) const {
  const std::int64_t word = rounded(range_m);
  if (word == 0) return code(kNotValid);
  for (const std::int64_t first : kFirstCodes) {
    if (word >= first && word < first + kCodes) return code(word - first);
  }
  const bool no_return = word >= first_code_ || (no_return_ && word >= *no_return_) || word == stated_maximum_;
  return no_return ? code(kBeyondMaximum) : static_cast<std::uint16_t>(word);
}

}  // namespace deltamap::drivers::carmen
