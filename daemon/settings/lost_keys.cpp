// SPDX-License-Identifier: Apache-2.0
#include "daemon/settings/lost_keys.hpp"

#include <cstddef>

namespace deltamap::daemon {

std::vector<std::string> losses(const SettingsReading& read, const Settings& in_force, const std::string& last_key) {
  std::vector<std::string> lines;
  const auto tell = [&](const std::string& what) { lines.push_back(read.file + ": " + what); };
  if (!read.ends_its_line) tell("ends in the middle of a line: is it cut? A whole file ends with a line feed");
  if (!last_key.empty() && !read.given.contains(last_key)) {
    tell("'" + last_key + "', with which it ended before, is gone: is it cut? Put the key back, or restart");
  }
  Settings wanted = read.settings;
  Settings present = in_force;
  const std::vector<SettingKey> after = keys_of(wanted);
  const std::vector<SettingKey> before = keys_of(present);
  for (std::size_t i = 0; i < after.size(); ++i) {
    const std::string& key = after[i].name;
    if (!after[i].is_live || read.given.contains(key) || after[i].text() == before[i].text()) continue;
    tell("'" + key + "' is gone: " + before[i].text() + " is in force, " + after[i].text() +
         " is as delivered; write the one that is meant");
  }
  return lines;
}

}  // namespace deltamap::daemon
