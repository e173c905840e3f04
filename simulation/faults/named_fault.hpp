// SPDX-License-Identifier: Apache-2.0
// Faults by their names, as a scenario and `deltamap sim --fault` order them: each with at most one number, from a
// moment on, for ever or for a while.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "simulation/faults/faults.hpp"

namespace deltamap::simulation {

struct NamedFault {
  std::string_view name;
  std::string_view meaning;
  std::string_view unit;  ///< of its number; empty: it takes none
  double usual = 0.0;     ///< its number where none is given
  double least = 0.0;
  double most = 0.0;
  void (*set)(Faults& faults, double number);  ///< begins
  void (*clear)(Faults& faults);               ///< all that it has set is at its default again
};
[[nodiscard]] std::span<const NamedFault> named_faults();

struct FaultOrder {
  const NamedFault* fault = nullptr;  ///< one of named_faults()
  double number = 0.0;
  double after_s = 0.0;             ///< from the start, >= 0
  std::optional<double> lasts_s{};  ///< > 0; none: for ever
};

/// "laser-repeats" or "laser-constant=2.5". Throws std::invalid_argument: one line that says what is wrong and, for a
/// name that nobody knows, which there are.
[[nodiscard]] FaultOrder fault_order(const std::string& text, double after_s = 0.0,
                                     std::optional<double> lasts_s = std::nullopt);
/// "laser-constant=2.5 from 20 s for 10 s".
[[nodiscard]] std::string described(const FaultOrder& order);

/// The orders of a run: begins and ends them at their times.
class FaultSchedule {
 public:
  explicit FaultSchedule(std::vector<FaultOrder> orders) : orders_{std::move(orders)}, states_(orders_.size()) {}

  /// What begins and ends up to that time since the start.
  void apply(double time_s, Faults& faults);

 private:
  enum class State : std::uint8_t { kWaiting, kOn, kOver };
  std::vector<FaultOrder> orders_;
  std::vector<State> states_;
};

}  // namespace deltamap::simulation
