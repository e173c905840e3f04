// SPDX-License-Identifier: Apache-2.0
// One key of the configuration: its name, the field that it sets, type, unit, range, meaning and symbol. The list of
// all keys is the one source of the strict reader, --print-config, the settings' fingerprint, config/default.yaml,
// docs/configuration.md and the JSON schema; the default of a key is the value of its field in Settings{}.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/geometry/angle.hpp"
#include "core/geometry/pose2.hpp"

namespace deltamap::daemon {

/// A value as the file has it, before anybody knows its type.
struct SettingValue {
  enum class Kind : std::uint8_t { kNull, kScalar, kList } kind = Kind::kNull;
  std::vector<std::string> items;  ///< one for a scalar
  bool quoted = false;             ///< a quoted scalar is text, never a number or a flag
};

struct SettingKey {
  enum class Type : std::uint8_t { kNumber, kWhole, kFlag, kText, kWord, kPose, kBearings } type = Type::kText;
  std::string name;                  ///< "laser.mount.x_m"
  std::string meaning{};             ///< one line that stands alone
  std::string unit{};                ///< of a number: "m/s"; empty: none
  std::optional<double> low{};       ///< least number, in the unit of the file; nothing: no limit
  std::optional<double> high{};      ///< greatest number
  std::vector<std::string> words{};  ///< those that a kWord takes
  std::string symbol{};              ///< in the paper, with its equation, or in the textbook; empty: none
  bool affects_result = true;        ///< whether another value can give another trajectory or map from the same bytes
  bool is_live = false;              ///< whether a reload may change it while the daemon runs
  std::function<std::string()> text{};  ///< the present value as YAML
  /// Sets the field, or answers what the key needs and leaves the field alone.
  std::function<std::optional<std::string>(const SettingValue&)> assign{};
};

/// Unit and range, or the words that it takes: "m, 0 to 100", "cm | mm"; empty for a text.
[[nodiscard]] std::string limits_of(const SettingKey& key);

[[nodiscard]] SettingKey number_key(std::string name, double& field, std::string unit, double low, double high,
                                    std::string meaning);
/// A field in radians that the file writes in degrees; the name's end tells "deg", "deg_per_s" or "deg_per_s2".
[[nodiscard]] SettingKey degrees_key(std::string name, double& field_rad, double low_deg, double high_deg,
                                     std::string meaning);
[[nodiscard]] SettingKey flag_key(std::string name, bool& field, std::string meaning);
[[nodiscard]] SettingKey text_key(std::string name, std::string& field, std::string meaning);
/// [x m, y m, heading deg], or null for none.
[[nodiscard]] SettingKey pose_key(std::string name, std::optional<Pose2>& field, std::string meaning);
/// A list of pairs of bearings in degrees, from and to; empty for none.
[[nodiscard]] SettingKey bearings_key(std::string name, std::function<std::vector<double>()> read_deg,
                                      std::function<void(const std::vector<double>&)> write_deg, std::string meaning);
/// One word of several; those that look like numbers are numbers in the file. `read` answers the index of the present
/// one.
[[nodiscard]] SettingKey word_key(std::string name, const std::vector<std::string>& words,
                                  std::function<std::size_t()> read, std::function<void(std::size_t)> write,
                                  std::string meaning);
[[nodiscard]] SettingKey whole_key(std::string name, std::function<std::int64_t()> read,
                                   std::function<void(std::int64_t)> write, std::string unit, std::int64_t low,
                                   std::int64_t high, std::string meaning);
/// The key, known by that symbol.
[[nodiscard]] SettingKey with_symbol(SettingKey key, std::string symbol);

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
  words.reserve(choices.size());
  for (const auto& choice : choices) words.push_back(choice.first);
  const auto read = [&field, choices] {
    std::size_t index = 0;
    while (index + 1 < choices.size() && choices[index].second != field) ++index;
    return index;
  };
  return word_key(
      std::move(name), words, read, [&field, choices](std::size_t index) { field = choices[index].second; },
      std::move(meaning));
}

}  // namespace deltamap::daemon
