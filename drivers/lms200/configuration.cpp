// SPDX-License-Identifier: Apache-2.0
#include "drivers/lms200/configuration.hpp"

#include <algorithm>

namespace deltamap::drivers::lms200 {

std::optional<Units> units_named(std::string_view name) {
  if (name == "cm") return Units::kCentimetre;
  if (name == "mm") return Units::kMillimetre;
  return std::nullopt;
}

std::optional<Configuration> configuration_with(std::span<const std::uint8_t> bytes, const Configuration& before) {
  if (bytes.empty() || bytes.size() > Configuration::kSize) return std::nullopt;
  Configuration after = before;
  std::copy(bytes.begin(), bytes.end(), after.bytes.begin());
  return after;
}

std::optional<RangeCoding> range_coding(std::uint8_t measuring_mode) {
  switch (measuring_mode) {
    case 0x00:
    case 0x01:
    case 0x02:
      return RangeCoding{0x1FFF, 0x1FF7};
    case 0x03:
    case 0x04:
      return RangeCoding{0x3FFF, 0x3FF7};
    case 0x05:
    case 0x06:
      return RangeCoding{0x7FFF, 0x7FF7};
    case 0x0F:  // no flags; the longest range is that of the 15-bit modes
      return RangeCoding{0xFFFF, 0x7FF7};
    default:
      return std::nullopt;
  }
}

}  // namespace deltamap::drivers::lms200
