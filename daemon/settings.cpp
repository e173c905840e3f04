// SPDX-License-Identifier: Apache-2.0
#include "daemon/settings.hpp"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <numeric>
#include <set>
#include <sstream>

#include "daemon/fingerprint.hpp"

namespace deltamap::daemon {
namespace {

std::size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0]++;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t changed = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({row[j + 1] + 1, row[j] + 1, changed});
    }
  }
  return row.back();
}

/// Walks a YAML tree and hands every leaf to its key.
class Reader {
 public:
  Reader(const std::vector<SettingKey>& keys, std::string place) : keys_{keys}, place_{std::move(place)} {}
  explicit Reader(const std::vector<SettingKey>& keys, std::string file, bool) : Reader(keys, std::move(file)) {
    counts_lines_ = true;
  }

  void read(const std::string& path, const YAML::Node& node) const {
    const auto key = std::find_if(keys_.begin(), keys_.end(), [&](const SettingKey& k) { return k.name == path; });
    if (key != keys_.end()) return assign(*key, node);
    if (!path.empty() && !is_section(path)) {
      refuse(node, "unknown key '" + path + "'; the nearest known key is '" + nearest(path) + "'");
    }
    if (node.IsNull()) return;  // an empty section
    if (!node.IsMap()) refuse(node, (path.empty() ? "the file" : "'" + path + "'") + " must hold keys");
    std::set<std::string> seen;
    for (const auto& entry : node) {
      if (!entry.first.IsScalar()) refuse(entry.first, "a key must be a word");
      const std::string child = path.empty() ? entry.first.Scalar() : path + "." + entry.first.Scalar();
      if (!seen.insert(child).second) refuse(entry.first, "'" + child + "' is given twice");
      if (!is_known(child)) {
        refuse(entry.first, "unknown key '" + child + "'; the nearest known key is '" + nearest(child) + "'");
      }
      read(child, entry.second);
    }
  }

  [[noreturn]] void refuse(const YAML::Node& node, const std::string& why) const { refuse(node.Mark().line, why); }
  [[noreturn]] void refuse(int line, const std::string& why) const {
    throw SettingsError(place_ + (counts_lines_ ? ":" + std::to_string(line + 1) : "") + ": " + why);
  }

 private:
  [[nodiscard]] bool is_section(const std::string& path) const {
    return std::any_of(keys_.begin(), keys_.end(), [&](const SettingKey& k) { return k.name.starts_with(path + "."); });
  }
  [[nodiscard]] bool is_known(const std::string& path) const {
    return is_section(path) ||
           std::any_of(keys_.begin(), keys_.end(), [&](const SettingKey& k) { return k.name == path; });
  }
  [[nodiscard]] const std::string& nearest(const std::string& path) const {
    return std::min_element(keys_.begin(), keys_.end(),
                            [&](const SettingKey& a, const SettingKey& b) {
                              return edit_distance(a.name, path) < edit_distance(b.name, path);
                            })
        ->name;
  }

  void assign(const SettingKey& key, const YAML::Node& node) const {
    SettingValue value;
    if (node.IsScalar()) value = {SettingValue::Kind::kScalar, {node.Scalar()}, node.Tag() == "!"};
    if (node.IsMap()) refuse(node, "'" + key.name + "' takes one value, not keys");
    if (node.IsSequence()) {
      value.kind = SettingValue::Kind::kList;
      for (const auto& item : node) {
        if (!item.IsScalar()) refuse(node, "'" + key.name + "' takes no nested lists");
        value.items.push_back(item.Scalar());
      }
    }
    if (const auto needed = key.assign(value)) {
      const std::string found = node.IsScalar() ? "'" + node.Scalar() + "'" : node.IsNull() ? "nothing" : "a list";
      refuse(node, "'" + key.name + "' needs " + *needed + ", not " + found);
    }
  }

  const std::vector<SettingKey>& keys_;
  std::string place_;
  bool counts_lines_ = false;
};

YAML::Node loaded(const std::string& yaml, const Reader& reader) {
  try {
    return YAML::Load(yaml);
  } catch (const YAML::Exception& error) {
    reader.refuse(error.mark.line, "not YAML: " + error.msg);
  }
}

void apply_override(const std::vector<SettingKey>& keys, const std::string& override_text) {
  const Reader reader{keys, "--set " + override_text};
  const auto equals = override_text.find('=');
  if (equals == std::string::npos || equals == 0) reader.refuse(0, "give key=value");
  const std::string value = override_text.substr(equals + 1);
  // On a command line "key=" means empty text, not "nothing".
  reader.read(override_text.substr(0, equals), loaded(value.empty() ? "\"\"" : value, reader));
}

std::vector<std::string> parts_of(const std::string& name) {
  std::vector<std::string> parts{""};
  for (const char c : name) {
    if (c == '.')
      parts.emplace_back();
    else
      parts.back() += c;
  }
  return parts;
}

}  // namespace

Settings parse_settings(const std::string& yaml, const std::string& name, const std::vector<std::string>& overrides) {
  Settings settings;
  const std::vector<SettingKey> keys = keys_of(settings);
  const Reader reader{keys, name, true};
  reader.read("", loaded(yaml, reader));
  for (const std::string& text : overrides) apply_override(keys, text);
  if (const auto wrong = contradiction_in(settings)) throw SettingsError(name + ": " + *wrong);
  return settings;
}

Settings read_settings(const std::filesystem::path& file, const std::vector<std::string>& overrides) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  if (!in || std::filesystem::is_directory(file)) {
    const std::string why = std::filesystem::is_directory(file) ? "is a folder" : std::strerror(errno);
    throw SettingsError(file.string() + ": cannot read the settings: " + why);
  }
  text << in.rdbuf();
  return parse_settings(text.str(), file.string(), overrides);
}

std::string settings_as_yaml(const Settings& settings) {
  Settings copy = settings;
  std::string yaml =
      "# SPDX-License-Identifier: Apache-2.0\n"
      "# Every key of deltamap with its value: unit and range, then meaning.\n";
  std::vector<std::string> section;
  for (const SettingKey& key : keys_of(copy)) {
    std::vector<std::string> parts = parts_of(key.name);
    const std::string leaf = parts.back();
    parts.pop_back();
    const auto differ = std::mismatch(section.begin(), section.end(), parts.begin(), parts.end());
    for (auto part = differ.second; part != parts.end(); ++part) {
      const auto depth = static_cast<std::size_t>(part - parts.begin());
      yaml += (depth == 0 ? "\n" : "") + std::string(2 * depth, ' ') + *part + ":\n";
    }
    section = parts;
    std::string line = std::string(2 * parts.size(), ' ') + leaf + ": " + key.text();
    line.resize(std::max<std::size_t>(line.size() + 1, 40), ' ');
    yaml += line + "# " + (key.limits.empty() ? "" : key.limits + ": ") + key.meaning + "\n";
  }
  return yaml;
}

std::vector<std::pair<std::string, std::string>> changed_settings(const Settings& settings) {
  Settings copy = settings;
  Settings as_delivered;
  const auto ours = keys_of(copy);
  const auto delivered = keys_of(as_delivered);
  std::vector<std::pair<std::string, std::string>> changed;
  for (std::size_t i = 0; i < ours.size(); ++i) {
    const std::string text = ours[i].text();
    if (text != delivered[i].text()) changed.emplace_back(ours[i].name, text);
  }
  return changed;
}

std::uint64_t settings_fingerprint(const Settings& settings) {
  Settings copy = settings;
  std::string all;
  for (const SettingKey& key : keys_of(copy)) {
    if (key.affects_result) all += key.name + "=" + key.text() + "\n";
  }
  return fingerprint_of(all);
}

}  // namespace deltamap::daemon
