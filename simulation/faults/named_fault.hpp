// SPDX-License-Identifier: Apache-2.0
// Faults by their names, as a scenario, `deltamap sim --fault` and orders on its standard input want them: each with at
// most one number, from a moment on, for ever or for a while.
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
  void (*clear)(Faults& faults);               ///< all that it has set is at its default again; null: momentary

  [[nodiscard]] bool is_momentary() const { return clear == nullptr; }
};
[[nodiscard]] std::span<const NamedFault> named_faults();
/// A line for each.
[[nodiscard]] std::string fault_help();

inline constexpr double kShortestFault_s = 0.01;

struct FaultOrder {
  const NamedFault* fault = nullptr;  ///< one of named_faults()
  double number = 0.0;
  double after_s = 0.0;             ///< from the start, >= 0
  std::optional<double> lasts_s{};  ///< > 0; none: for ever, and of what is momentary
};

/// "[T:]NAME[:NUMBER][:SECONDS]", or NAME=NUMBER: "laser-repeats", "20:laser-constant:2.5:10", "laser-constant=2.5". T
/// is added to `after_s`, SECONDS take precedence over `lasts_s`. Throws std::invalid_argument: one line that says what
/// is wrong and, for a name that nobody knows, which there are.
[[nodiscard]] FaultOrder fault_order(const std::string& text, double after_s = 0.0,
                                     std::optional<double> lasts_s = std::nullopt);
/// "laser-constant=2.5 from 20 s for 10 s".
[[nodiscard]] std::string described(const FaultOrder& order);

/// The orders of a run: begins and ends them at their times.
class FaultSchedule {
 public:
  explicit FaultSchedule(const std::vector<FaultOrder>& orders) {
    for (const FaultOrder& order : orders) add(order);
  }

  void add(const FaultOrder& order) { entries_.push_back({order}); }
  /// What begins and ends up to that time since the start.
  void apply(double time_s, Faults& faults);
  /// Those of that name, or all, end now, and those that wait never begin. Answers how many.
  std::size_t end(std::string_view name, Faults& faults);
  /// That wait or hold.
  [[nodiscard]] std::vector<FaultOrder> orders() const;

 private:
  struct Entry {
    FaultOrder order;
    bool is_on = false;
    bool is_over = false;
  };
  std::vector<Entry> entries_;
};

}  // namespace deltamap::simulation
