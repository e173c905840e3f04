// SPDX-License-Identifier: Apache-2.0
#include "daemon/nearest_key.hpp"

#include <algorithm>
#include <numeric>
#include <optional>

namespace deltamap::daemon {
namespace {

std::size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (const char letter : a) {
    std::size_t diagonal = row[0]++;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t changed = diagonal + (letter == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({row[j + 1] + 1, row[j] + 1, changed});
    }
  }
  return row.back();
}

/// Nothing where more than half of it would have to be written anew.
std::optional<std::string> nearest_of(const std::vector<std::string>& names, const std::string& path) {
  std::optional<std::string> nearest;
  std::size_t least = path.size() / 2 + 1;
  for (const std::string& name : names) {
    const std::size_t distance = edit_distance(name, path);
    if (distance >= least) continue;
    least = distance;
    nearest = name;
  }
  return nearest;
}

std::vector<std::string> names_of(const std::vector<SettingKey>& keys) {
  std::vector<std::string> names;
  names.reserve(keys.size());
  for (const SettingKey& key : keys) names.push_back(key.name);
  return names;
}

}  // namespace

std::vector<std::string> sections_of(const std::vector<SettingKey>& keys) {
  std::vector<std::string> sections;
  for (const SettingKey& key : keys) {
    for (auto dot = key.name.find('.'); dot != std::string::npos; dot = key.name.find('.', dot + 1)) {
      const std::string section = key.name.substr(0, dot);
      if (std::find(sections.begin(), sections.end(), section) == sections.end()) sections.push_back(section);
    }
  }
  return sections;
}

std::string unknown_key_line(const std::vector<SettingKey>& keys, const std::string& path, bool has_keys_below) {
  const auto section = nearest_of(sections_of(keys), path);
  const auto key = nearest_of(names_of(keys), path);
  const std::string unknown = std::string("unknown ") + (has_keys_below ? "section" : "key") + " '" + path + "'; ";
  if (section && (has_keys_below || !key)) return unknown + "the nearest known section is '" + *section + "'";
  if (key) return unknown + "the nearest known key is '" + *key + "'";
  return unknown + "no known one is near it: --print-config lists them all";
}

}  // namespace deltamap::daemon
