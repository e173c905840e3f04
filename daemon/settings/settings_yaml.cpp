// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "core/files/shortest_text.hpp"
#include "daemon/settings/settings_documents.hpp"
#include "daemon/settings/settings_sections.hpp"

namespace deltamap::daemon {
namespace {

constexpr std::size_t kCommentColumn = 40;

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

/// The headings of all sections that begin with this key.
std::string headings(const std::vector<std::string>& before, const std::vector<std::string>& now) {
  std::string yaml;
  std::string path;
  bool is_new = false;
  for (std::size_t depth = 0; depth < now.size(); ++depth) {
    path += (depth == 0 ? "" : ".") + now[depth];
    is_new = is_new || depth >= before.size() || before[depth] != now[depth];
    if (!is_new) continue;
    const std::string indentation(2 * depth, ' ');
    yaml += (depth == 0 ? "\n" : "") + indentation + "# " + meaning_of_section(path) + "\n";
    yaml += indentation + now[depth] + ":\n";
  }
  return yaml;
}

std::string comment_of(const SettingKey& key) {
  const std::string limits = limits_of(key);
  return (limits.empty() ? "" : limits + ": ") + key.meaning + (key.symbol.empty() ? "" : " (" + key.symbol + ")");
}

}  // namespace

std::string settings_as_yaml(const Settings& settings) {
  Settings copy = settings;
  std::string yaml =
      "# yaml-language-server: $schema=/usr/share/deltamap/deltamap.schema.json\n"
      "# SPDX-License-Identifier: Apache-2.0\n"
      "# Every key of deltamap with its value: unit and range, then meaning (symbol). What a file leaves out is as\n"
      "# delivered. A reload takes navigation.safety and navigation.wander; every other key needs a restart.\n";
  std::vector<std::string> section;
  for (const SettingKey& key : keys_of(copy)) {
    std::vector<std::string> parts = parts_of(key.name);
    const std::string leaf = parts.back();
    parts.pop_back();
    yaml += headings(section, parts);
    section = parts;
    std::string line(2 * parts.size(), ' ');
    line += leaf;
    line += ": ";
    line += key.type == SettingKey::Type::kNumber ? yaml_number(key.text()) : key.text();
    line.resize(std::max(line.size() + 1, kCommentColumn), ' ');
    yaml += line + "# " + comment_of(key) + "\n";
  }
  return yaml;
}

}  // namespace deltamap::daemon
