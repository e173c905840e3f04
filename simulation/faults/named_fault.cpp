// SPDX-License-Identifier: Apache-2.0
#include "simulation/faults/named_fault.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <stdexcept>

namespace deltamap::simulation {
namespace {

constexpr double kLongestFault_s = 1e6;

std::string shown(double number) {
  char text[32];
  (void)std::snprintf(text, sizeof text, "%g", number);
  return text;
}

[[noreturn]] void refuse(const std::string& text, const std::string& why) {
  throw std::invalid_argument("fault \"" + text + "\" " + why);
}

const NamedFault& fault_named(std::string_view name, const std::string& text) {
  const auto faults = named_faults();
  const auto found =
      std::find_if(faults.begin(), faults.end(), [&](const NamedFault& fault) { return fault.name == name; });
  if (found != faults.end()) return *found;
  std::string names;
  for (const NamedFault& fault : faults) names += (names.empty() ? "" : ", ") + std::string(fault.name);
  refuse(text, "is unknown: one of " + names);
}

std::optional<double> number_in(std::string_view digits) {
  double number = 0.0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
  if (error != std::errc{} || end != digits.data() + digits.size() || !std::isfinite(number)) return std::nullopt;
  return number;
}

std::string range_of(const NamedFault& fault) {
  return "a number from " + shown(fault.least) + " to " + shown(fault.most) + " (" + std::string(fault.unit) + ")";
}

double number_of(const NamedFault& fault, std::string_view digits, const std::string& text) {
  if (fault.unit.empty()) refuse(text, "takes no number");
  const auto number = number_in(digits);
  if (!number || *number < fault.least || *number > fault.most) refuse(text, "takes " + range_of(fault));
  return *number;
}

/// Cuts the next part off; its separator goes with it.
std::string_view taken(std::string_view& text, char separator) {
  const std::size_t at = std::min(text.find(separator), text.size());
  const std::string_view part = text.substr(0, at);
  text.remove_prefix(std::min(at + 1, text.size()));
  return part;
}

double seconds_of(std::string_view digits, double least, const std::string& text) {
  const auto duration_s = number_in(digits);
  if (!duration_s || *duration_s < least || *duration_s > kLongestFault_s)
    refuse(text, "takes a number of seconds from " + shown(least) + " to " + shown(kLongestFault_s));
  return *duration_s;
}

}  // namespace

FaultOrder fault_order(const std::string& text, double after_s, std::optional<double> lasts_s) {
  std::string_view left{text};
  std::string_view name = taken(left, ':');
  if (number_in(name)) {
    after_s += seconds_of(name, 0.0, text);
    name = taken(left, ':');
  }
  const bool has_number = name.find('=') != std::string_view::npos;
  std::string_view digits = name;
  const NamedFault& fault = fault_named(taken(digits, '='), text);
  if (!has_number) digits = fault.unit.empty() ? std::string_view{} : taken(left, ':');
  const double number = has_number || !digits.empty() ? number_of(fault, digits, text) : fault.usual;
  if (!left.empty()) lasts_s = seconds_of(left, kShortestFault_s, text);
  if (lasts_s && fault.is_momentary()) refuse(text, "is over in a moment: it takes no seconds that it lasts");
  return {&fault, number, after_s, lasts_s};
}

std::string described(const FaultOrder& order) {
  std::string text{order.fault->name};
  if (!order.fault->unit.empty()) text += "=" + shown(order.number);
  text += (order.fault->is_momentary() ? " at " : " from ") + shown(order.after_s) + " s";
  if (order.lasts_s) text += " for " + shown(*order.lasts_s) + " s";
  return text;
}

std::string fault_help() {
  std::string lines;
  for (const NamedFault& fault : named_faults()) {
    char line[64];
    (void)std::snprintf(line, sizeof line, "  %-22s", std::string(fault.name).c_str());
    lines += line + std::string(fault.meaning);
    if (!fault.unit.empty()) lines += "; " + range_of(fault) + ", usually " + shown(fault.usual);
    lines += fault.is_momentary() ? "; over in a moment\n" : "\n";
  }
  return lines;
}

std::vector<FaultOrder> FaultSchedule::orders() const {
  std::vector<FaultOrder> open;
  for (const Entry& entry : entries_) open.push_back(entry.order);
  return open;
}

void FaultSchedule::apply(double time_s, Faults& faults) {
  for (Entry& entry : entries_) {
    const FaultOrder& order = entry.order;
    if (!entry.is_on && time_s >= order.after_s) {
      order.fault->set(faults, order.number);
      entry.is_on = true;
    } else if (entry.is_on && order.lasts_s && time_s >= order.after_s + *order.lasts_s) {
      order.fault->clear(faults);
      entry.is_over = true;
    }
    if (entry.is_on && order.fault->is_momentary()) entry.is_over = true;
  }
  std::erase_if(entries_, [](const Entry& entry) { return entry.is_over; });
}

std::size_t FaultSchedule::end(std::string_view name, Faults& faults) {
  return std::erase_if(entries_, [&](const Entry& entry) {
    if (!name.empty() && entry.order.fault->name != name) return false;
    if (entry.is_on) entry.order.fault->clear(faults);
    return true;
  });
}

}  // namespace deltamap::simulation
