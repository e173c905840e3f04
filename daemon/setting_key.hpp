// SPDX-License-Identifier: Apache-2.0
// One key of the configuration: its name, the field that it sets, unit, range and meaning. A list of these serves
// reading, --print-config, the settings' fingerprint and the test that holds config/default.yaml against the defaults
// in code.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/angle.hpp"
#include "core/pose2.hpp"

namespace deltamap::daemon {

/// A value as the file has it, before anybody knows its type.
struct SettingValue {
  enum class Kind : std::uint8_t { kNull, kScalar, kList } kind = Kind::kNull;
  std::vector<std::string> items;  ///< one for a scalar
  bool quoted = false;             ///< a quoted scalar is text, never a number or a flag
};

struct SettingKey {
  std::string name;                   ///< "laser.mount.x_m"
  std::string meaning;                ///< one line
  std::string limits;                 ///< unit and range in words: "m, 0 to 100"
  bool affects_result = true;         ///< whether another value can give another trajectory or map from the same bytes
  bool is_live = false;               ///< whether a reload may change it while the daemon runs
  std::function<std::string()> text;  ///< the present value as YAML
  /// Sets the field, or answers what the key needs and leaves the field alone.
  std::function<std::optional<std::string>(const SettingValue&)> assign;
};

[[nodiscard]] SettingKey number_key(std::string name, double& field, std::string unit, double low, double high,
                                    std::string meaning);
/// A field in radians that the file writes in degrees.
[[nodiscard]] SettingKey degrees_key(std::string name, double& field_rad, double low_deg, double high_deg,
                                     std::string meaning);
[[nodiscard]] SettingKey flag_key(std::string name, bool& field, std::string meaning);
[[nodiscard]] SettingKey text_key(std::string name, std::string& field, std::string meaning);
/// [x m, y m, heading deg], or null for none.
[[nodiscard]] SettingKey pose_key(std::string name, std::optional<Pose2>& field, std::string meaning);
/// One word of several. `read` answers the index of the present one.
[[nodiscard]] SettingKey word_key(std::string name, std::vector<std::string> words, std::function<std::size_t()> read,
                                  std::function<void(std::size_t)> write, std::string meaning);
[[nodiscard]] SettingKey whole_key(std::string name, std::function<std::int64_t()> read,
                                   std::function<void(std::int64_t)> write, std::string unit, std::int64_t low,
                                   std::int64_t high, std::string meaning);

template <typename Integer>
[[nodiscard]] SettingKey whole_key(std::string name, Integer& field, std::string unit, std::int64_t low,
                                   std::int64_t high, std::string meaning) {
  return whole_key(
      std::move(name), [&field] { return static_cast<std::int64_t>(field); },
      [&field](std::int64_t value) { field = static_cast<Integer>(value); }, std::move(unit), low, high,
      std::move(meaning));
}

template <typename Enum>
[[nodiscard]] SettingKey choice_key(std::string name, Enum& field, std::vector<std::pair<std::string, Enum>> choices,
                                    std::string meaning) {
  std::vector<std::string> words;
  for (const auto& choice : choices) words.push_back(choice.first);
  const auto read = [&field, choices] {
    std::size_t index = 0;
    while (index + 1 < choices.size() && choices[index].second != field) ++index;
    return index;
  };
  return word_key(
      std::move(name), std::move(words), read, [&field, choices](std::size_t index) { field = choices[index].second; },
      std::move(meaning));
}

}  // namespace deltamap::daemon
