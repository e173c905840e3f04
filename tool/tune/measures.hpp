// SPDX-License-Identifier: Apache-2.0
// What is measured of a run, and which way is better.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace deltamap::tool::tune {

enum class Better : std::uint8_t { kLess, kMore, kNeither };

struct Measure {
  std::string_view name;
  std::string_view unit;  ///< empty: a share or a count
  Better better = Better::kLess;
  std::string_view what;  ///< one line

  /// The value as a cost: less is better.
  [[nodiscard]] double cost(double value) const { return better == Better::kMore ? -value : value; }
};

/// All, in the order in which they are told.
[[nodiscard]] std::span<const Measure> measures();
/// Throws std::runtime_error that names the nearest one.
[[nodiscard]] const Measure& measure_named(const std::string& name);

/// Of one run: what could be measured, in that order.
using Numbers = std::vector<std::pair<std::string, double>>;
/// NaN where it was not measured.
[[nodiscard]] double number_of(const Numbers& numbers, std::string_view name);

}  // namespace deltamap::tool::tune
