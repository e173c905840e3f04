// SPDX-License-Identifier: Apache-2.0
#include "daemon/settings/reader/setting_key.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <limits>

#include "core/files/shortest_text.hpp"

namespace deltamap::daemon {
namespace {

template <typename Number>
std::optional<Number> parsed(const std::string& text) {
  if (text.starts_with("+-")) return std::nullopt;
  Number value{};
  const char* last = text.data() + text.size();
  const auto [end, error] = std::from_chars(text.data() + (text.starts_with('+') ? 1 : 0), last, value);
  if (error != std::errc{} || end != last) return std::nullopt;
  return value;
}

// 10° is kept as 0.17453292519943295 rad and must be written as 10 again.
std::string rounded(double value) {
  char buffer[32];
  const int length = std::snprintf(buffer, sizeof buffer, "%.10g", value);
  return {buffer, static_cast<std::size_t>(length)};
}

/// A whole number that no field could hold.
bool is_longer_than_any(const SettingValue& value) {
  if (value.kind != SettingValue::Kind::kScalar || value.quoted) return false;
  const std::string& text = value.items.front();
  const std::size_t digits = text.find_first_not_of("+-");
  return digits <= 1 && text.find_first_not_of("0123456789", digits) == std::string::npos;
}

std::optional<double> number_in(const SettingValue& value) {
  if (value.kind != SettingValue::Kind::kScalar || value.quoted) return std::nullopt;
  const auto number = parsed<double>(value.items.front());
  return number && std::isfinite(*number) ? number : std::nullopt;
}

std::string range_in_words(const SettingKey& key) {
  if (!key.low) return "";
  return key.high ? rounded(*key.low) + " to " + rounded(*key.high) : "from " + rounded(*key.low);
}

std::string degrees_unit(const std::string& name) {
  if (name.ends_with("_deg_per_s2")) return "degrees/s^2";
  return name.ends_with("_deg_per_s") ? "degrees/s" : "degrees";
}

SettingKey scaled_key(std::string name, double& field, double file_per_field, std::string unit, double low, double high,
                      std::string meaning) {
  SettingKey key{.type = SettingKey::Type::kNumber,
                 .name = std::move(name),
                 .meaning = std::move(meaning),
                 .unit = std::move(unit),
                 .low = low,
                 .high = high};
  key.text = [&field, file_per_field] {
    return file_per_field == 1.0 ? shortest_text(field) : rounded(field * file_per_field);
  };
  key.assign = [&field, file_per_field, low, high,
                limits = limits_of(key)](const SettingValue& value) -> std::optional<std::string> {
    const auto number = number_in(value);
    if (!number) return "a number (" + limits + ")";
    if (*number < low || *number > high) return "a number in its range (" + limits + ")";
    field = file_per_field == 1.0 ? *number : radians(*number);
    return std::nullopt;
  };
  return key;
}

bool needs_quotes(const std::string& text) {
  if (text.empty() || text == "~" || text == "null" || text == "true" || text == "false") return true;
  if (parsed<double>(text) || text.front() == ' ' || text.back() == ' ') return true;
  if (std::string("-?:,[]{}#&*!|>'\"%@`").find(text.front()) != std::string::npos) return true;
  return text.find(": ") != std::string::npos || text.find(" #") != std::string::npos;
}

}  // namespace

std::string limits_of(const SettingKey& key) {
  using Type = SettingKey::Type;
  if (key.type == Type::kFlag) return "true or false";
  if (key.type == Type::kPose) return "[x m, y m, heading degrees] or null";
  if (key.type == Type::kBearings) return "[[from, to], …] degrees, from below to, -180 to 180";
  std::string limits = key.unit;
  for (const std::string& word : key.words) limits += (limits.empty() ? "" : " | ") + word;
  const std::string range = range_in_words(key);
  return limits + (limits.empty() || range.empty() ? "" : ", ") + range;
}

SettingKey with_symbol(SettingKey key, std::string symbol) {
  key.symbol = std::move(symbol);
  return key;
}

SettingKey number_key(std::string name, double& field, std::string unit, double low, double high, std::string meaning) {
  return scaled_key(std::move(name), field, 1.0, std::move(unit), low, high, std::move(meaning));
}

SettingKey degrees_key(std::string name, double& field_rad, double low_deg, double high_deg, std::string meaning) {
  std::string unit = degrees_unit(name);
  return scaled_key(std::move(name), field_rad, degrees(1.0), std::move(unit), low_deg, high_deg, std::move(meaning));
}

SettingKey flag_key(std::string name, bool& field, std::string meaning) {
  SettingKey key{.type = SettingKey::Type::kFlag, .name = std::move(name), .meaning = std::move(meaning)};
  key.text = [&field] { return field ? "true" : "false"; };
  key.assign = [&field](const SettingValue& value) -> std::optional<std::string> {
    if (value.kind != SettingValue::Kind::kScalar || value.quoted) return "true or false";
    if (value.items.front() != "true" && value.items.front() != "false") return "true or false";
    field = value.items.front() == "true";
    return std::nullopt;
  };
  return key;
}

SettingKey text_key(std::string name, std::string& field, std::string meaning) {
  SettingKey key{.type = SettingKey::Type::kText, .name = std::move(name), .meaning = std::move(meaning)};
  key.text = [&field] {
    if (!needs_quotes(field)) return field;
    std::string quoted = "\"";
    for (const char c : field) {
      if (c == '"' || c == '\\') quoted += '\\';
      quoted += c;
    }
    return quoted + '"';
  };
  key.assign = [&field](const SettingValue& value) -> std::optional<std::string> {
    if (value.kind != SettingValue::Kind::kScalar) return "text (\"\" for none)";
    field = value.items.front();
    return std::nullopt;
  };
  return key;
}

SettingKey pose_key(std::string name, std::optional<Pose2>& field, std::string meaning) {
  SettingKey key{.type = SettingKey::Type::kPose, .name = std::move(name), .meaning = std::move(meaning)};
  key.text = [&field]() -> std::string {
    if (!field) return "null";
    return "[" + yaml_number(field->x) + ", " + yaml_number(field->y) + ", " + rounded(degrees(field->theta)) + "]";
  };
  key.assign = [&field, limits = limits_of(key)](const SettingValue& value) -> std::optional<std::string> {
    if (value.kind == SettingValue::Kind::kNull) {
      field.reset();
      return std::nullopt;
    }
    std::vector<double> numbers;
    for (const std::string& item : value.items) {
      const auto number = number_in({SettingValue::Kind::kScalar, {item}});
      if (number) numbers.push_back(*number);
    }
    if (value.kind != SettingValue::Kind::kList || value.items.size() != 3 || numbers.size() != 3) {
      return limits;
    }
    field = Pose2{numbers[0], numbers[1], wrapped_angle(radians(numbers[2]))};
    return std::nullopt;
  };
  return key;
}

SettingKey bearings_key(std::string name, std::function<std::vector<double>()> read_deg,
                        std::function<void(const std::vector<double>&)> write_deg, std::string meaning) {
  SettingKey key{
      .type = SettingKey::Type::kBearings, .name = std::move(name), .meaning = std::move(meaning), .unit = "degrees"};
  key.text = [read_deg = std::move(read_deg)] {
    const std::vector<double> bearings_deg = read_deg();
    std::string text;
    for (std::size_t i = 0; i + 1 < bearings_deg.size(); i += 2)
      text += (i == 0 ? "[" : ", [") + rounded(bearings_deg[i]) + ", " + rounded(bearings_deg[i + 1]) + "]";
    return "[" + text + "]";
  };
  key.assign = [limits = limits_of(key),
                write_deg = std::move(write_deg)](const SettingValue& value) -> std::optional<std::string> {
    if (value.kind != SettingValue::Kind::kList) return limits;
    std::vector<double> numbers;
    for (const std::string& pair : value.items) {  // as the reader has it: "from to"
      const std::size_t gap = std::min(pair.find(' '), pair.size());
      const auto from = number_in({SettingValue::Kind::kScalar, {pair.substr(0, gap)}});
      const auto to = number_in({SettingValue::Kind::kScalar, {pair.substr(std::min(gap + 1, pair.size()))}});
      if (!from || !to || *from < -180.0 || *to > 180.0 || *from >= *to) return limits;
      numbers.insert(numbers.end(), {*from, *to});
    }
    write_deg(numbers);
    return std::nullopt;
  };
  return key;
}

SettingKey word_key(std::string name, const std::vector<std::string>& words, std::function<std::size_t()> read,
                    std::function<void(std::size_t)> write, std::string meaning) {
  SettingKey key{
      .type = SettingKey::Type::kWord, .name = std::move(name), .meaning = std::move(meaning), .words = words};
  key.text = [words, read = std::move(read)] { return words[read()]; };
  key.assign = [words, limits = limits_of(key),
                write = std::move(write)](const SettingValue& value) -> std::optional<std::string> {
    const auto found = value.kind == SettingValue::Kind::kScalar
                           ? std::find(words.begin(), words.end(), value.items.front())
                           : words.end();
    if (found == words.end()) return "one of " + limits;
    write(static_cast<std::size_t>(found - words.begin()));
    return std::nullopt;
  };
  return key;
}

SettingKey whole_key(std::string name, std::function<std::int64_t()> read, std::function<void(std::int64_t)> write,
                     std::string unit, std::int64_t low, std::int64_t high, std::string meaning) {
  SettingKey key{.type = SettingKey::Type::kWhole,
                 .name = std::move(name),
                 .meaning = std::move(meaning),
                 .unit = std::move(unit),
                 .low = static_cast<double>(low)};
  if (high != std::numeric_limits<std::int64_t>::max()) key.high = static_cast<double>(high);
  key.text = [read = std::move(read)] { return std::to_string(read()); };
  key.assign = [limits = limits_of(key), low, high,
                write = std::move(write)](const SettingValue& value) -> std::optional<std::string> {
    const auto number = value.kind == SettingValue::Kind::kScalar && !value.quoted
                            ? parsed<std::int64_t>(value.items.front())
                            : std::nullopt;
    if (!number && is_longer_than_any(value)) {
      return "a whole number in its range (" + std::to_string(low) + " to " + std::to_string(high) + ")";
    }
    if (!number) return "a whole number (" + limits + ")";
    if (*number < low || *number > high) return "a whole number in its range (" + limits + ")";
    write(*number);
    return std::nullopt;
  };
  return key;
}

}  // namespace deltamap::daemon
