// SPDX-License-Identifier: Apache-2.0
#include "tool/tune/parameter.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <optional>

#include "core/files/shortest_text.hpp"
#include "daemon/settings/reader/nearest_key.hpp"
#include "daemon/settings/settings.hpp"

namespace deltamap::tool::tune {
namespace {

using Type = daemon::SettingKey::Type;

constexpr int kMostValues = 1000;

[[noreturn]] void refuse(const std::string& text, const std::string& why) {
  throw daemon::SettingsError("--param " + text + ": " + why);
}

std::vector<std::string> split(const std::string& text, char at) {
  std::vector<std::string> parts{""};
  int depth = 0;  // inside of [ and ]
  for (const char c : text) {
    depth += c == '[' ? 1 : c == ']' ? -1 : 0;
    if (c == at && depth == 0) {
      parts.emplace_back();
    } else {
      parts.back() += c;
    }
  }
  return parts;
}

std::optional<double> number_in(const std::string& text) {
  double number = 0.0;
  const char* const end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, number);
  if (error != std::errc{} || rest != end || !std::isfinite(number)) return std::nullopt;
  return number;
}

/// What the key's range, or its type, says against the value. What it contradicts may be set beside it: that is told
/// where all settings of a run are read.
std::optional<std::string> objection(const std::string& key, const std::string& value) {
  try {
    (void)daemon::parse_settings("", "--param", {key + "=" + value});
  } catch (const daemon::SettingsError& error) {
    const std::size_t at = error.lines().front().find(key + ": needs");
    if (at != std::string::npos) return error.lines().front().substr(at);
  }
  return std::nullopt;
}

Parameter range_of(const std::string& text, const daemon::SettingKey& key, const std::vector<std::string>& parts) {
  if (key.type != Type::kNumber && key.type != Type::kWhole)
    refuse(text, "'" + key.name + "' is no number: give its values as " + key.name + "=v,v");
  Parameter parameter{.key = key.name, .is_range = true, .is_whole = key.type == Type::kWhole};
  const auto low = number_in(parts[0]);
  const auto high = number_in(parts[1]);
  const auto count = number_in(parts[2]);
  parameter.is_logarithmic = parts.size() == 4;
  if (!low || !high || !count || (parts.size() == 4 && parts[3] != "log"))
    refuse(text, "a range is a:b:n or a:b:n:log");
  if (*high <= *low) refuse(text, "a range goes up, from a to b");
  if (parameter.is_logarithmic && *low <= 0.0) refuse(text, "a range of equal factors begins above 0");
  if (*count < 2.0 || *count > kMostValues || *count != std::floor(*count))
    refuse(text, "n is a whole number from 2 to 1000");
  parameter.low = *low;
  parameter.high = *high;
  for (int i = 0; i < static_cast<int>(*count); ++i) {
    const std::string value = parameter.at(i / (*count - 1.0));
    if (parameter.values.empty() || parameter.values.back() != value) parameter.values.push_back(value);
  }
  return parameter;
}

}  // namespace

std::string Parameter::at(double share) const {
  if (!is_range) {
    const auto index = static_cast<std::size_t>(share * static_cast<double>(values.size()));
    return values[std::min(index, values.size() - 1)];
  }
  const double value = is_logarithmic ? low * std::pow(high / low, share) : low + share * (high - low);
  if (is_whole) return std::to_string(std::llround(value));
  if (share == 0.0 || share == 1.0) return shortest_text(share == 0.0 ? low : high);
  char text[32];
  (void)std::snprintf(text, sizeof text, "%.6g", value);  // what a person would write, not 0.30000000000000004
  return shortest_text(*number_in(text));
}

Parameter parameter_of(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos) refuse(text, "is none: key=a:b:n, key=a:b:n:log or key=v,v");
  const std::string name = text.substr(0, equals);
  const std::string given = text.substr(equals + 1);
  daemon::Settings settings;
  const auto keys = daemon::keys_of(settings);
  const auto key = std::find_if(keys.begin(), keys.end(), [&](const auto& one) { return one.name == name; });
  if (key == keys.end()) refuse(text, "'" + name + "': " + daemon::unknown_key(keys, name, false).rule);
  if (name == "seed") refuse(text, "seeds are what every value is tried with: --seeds N");
  if (!key->affects_result) refuse(text, "'" + name + "' changes nothing of a replay");
  const std::vector<std::string> parts = split(given, ':');
  Parameter parameter{.key = name};
  if (parts.size() == 3 || parts.size() == 4) {
    parameter = range_of(text, *key, parts);
  } else {
    for (const std::string& value : split(given, ',')) {
      if (std::find(parameter.values.begin(), parameter.values.end(), value) != parameter.values.end())
        refuse(text, value + " is given twice");
      parameter.values.push_back(value);
    }
  }
  for (const std::string& value : parameter.values) {
    if (const auto wrong = objection(name, value)) refuse(text, *wrong);
  }
  return parameter;
}

}  // namespace deltamap::tool::tune
