// SPDX-License-Identifier: Apache-2.0
#include "daemon/settings/reader/nearest_key.hpp"

#include <algorithm>
#include <iterator>
#include <numeric>

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

constexpr std::size_t kLongest = 200;  // a longer word is like no name, and the edit distances would take long

std::vector<std::string> names_of(const std::vector<SettingKey>& keys) {
  std::vector<std::string> names;
  names.reserve(keys.size());
  for (const SettingKey& key : keys) names.push_back(key.name);
  return names;
}

constexpr std::size_t kMostElsewhere = 3;  // keys with the same last part that are named as a hint; with more, none is

/// The names with the last part of `path`: "laser.port" and "robot.port" for "port" or "lase.prot.port".
std::vector<std::string> of_the_same_end(const std::vector<std::string>& names, const std::string& path) {
  const std::string end = "." + path.substr(path.rfind('.') + 1);
  std::vector<std::string> found;
  std::copy_if(names.begin(), names.end(), std::back_inserter(found),
               [&](const std::string& name) { return name.ends_with(end); });
  return found;
}

}  // namespace

std::optional<std::string> nearest_of(const std::vector<std::string>& names, const std::string& word) {
  if (word.size() > kLongest) return std::nullopt;
  std::optional<std::string> nearest;
  std::size_t least = word.size() / 2 + 1;
  for (const std::string& name : names) {
    const std::size_t distance = edit_distance(name, word);
    if (distance >= least) continue;
    least = distance;
    nearest = name;
  }
  return nearest;
}

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

UnknownKey unknown_key(const std::vector<SettingKey>& keys, const std::string& path, bool has_keys_below) {
  const std::vector<std::string> sections = sections_of(keys);
  const std::vector<std::string> names = names_of(keys);
  const std::string unknown = std::string("unknown ") + (has_keys_below ? "section" : "key");
  const auto section = nearest_of(sections, path);
  const auto key = nearest_of(names, path);
  if (section && (has_keys_below || !key)) return {unknown + " (nearest section " + *section + ")", {*section}};
  if (key) return {unknown + " (nearest key " + *key + ")", {*key}};
  const std::vector<std::string> elsewhere = of_the_same_end(has_keys_below ? sections : names, path);
  if (elsewhere.empty() || elsewhere.size() > kMostElsewhere) {
    return {unknown + " (none is near: --print-config lists them all)", {}};
  }
  std::string rule = unknown + " (nearest " + (has_keys_below ? "section " : "key ");
  for (const std::string& name : elsewhere) rule += (&name == &elsewhere.front() ? "" : " or ") + name;
  return {rule + ")", elsewhere};
}

}  // namespace deltamap::daemon
