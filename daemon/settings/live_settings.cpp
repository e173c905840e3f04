// SPDX-License-Identifier: Apache-2.0
#include "daemon/settings/live_settings.hpp"

#include <cstddef>

#include "daemon/settings/lost_keys.hpp"

namespace deltamap::daemon {
namespace {

/// "seed: 4 (in force 3)"
std::string changed_line(const std::string& key, const std::string& value, const char* what, const std::string& other) {
  std::string line = key;
  line.append(": ").append(value).append(" (").append(what).append(" ").append(other).append(")");
  return line;
}

}  // namespace

MergedSettings with_live_keys_of(const Settings& wanted, const Settings& in_force) {
  MergedSettings merged{.settings = in_force, .taken = {}, .for_a_restart = {}};
  Settings read = wanted;
  const std::vector<SettingKey> from = keys_of(read);
  const std::vector<SettingKey> to = keys_of(merged.settings);
  for (std::size_t i = 0; i < from.size(); ++i) {
    const std::string before = to[i].text();
    const std::string after = from[i].text();
    if (before == after) continue;
    // A live key is a number or a word: its text is its value.
    if (from[i].is_live && !to[i].assign({SettingValue::Kind::kScalar, {after}})) {
      merged.taken.push_back(changed_line(from[i].name, after, "before", before));
    } else {
      merged.for_a_restart.push_back(changed_line(from[i].name, after, "in force", before));
    }
  }
  return merged;
}

LiveSettings::Outcome LiveSettings::reload(const std::function<bool(const Settings&)>& take) {
  const std::scoped_lock one_after_another{mutex_};
  std::vector<std::string> lines;
  SettingsReading read;
  try {
    read = read_();
  } catch (const SettingsError& error) {
    lines = {"the settings stay as they are: the file cannot be taken"};
    lines.insert(lines.end(), error.lines().begin(), error.lines().end());
    return {false, lines};
  }
  lines = losses(read, in_force_, last_key_);
  if (!lines.empty()) {
    lines.insert(lines.begin(), "the settings stay as they are: the file does not say any more what it said");
    return {false, lines};
  }
  const MergedSettings merged = with_live_keys_of(read.settings, in_force_);
  for (const Contradiction& wrong : contradictions_in(merged.settings)) lines.push_back(wrong.key + ": " + wrong.what);
  if (!lines.empty()) {
    lines.insert(lines.begin(), "the settings stay as they are: with those that wait for a restart they contradict");
    return {false, lines};
  }
  if (!merged.taken.empty() && !take(merged.settings)) {
    return {false, {"the settings stay as they are: the daemon is busy, try again"}};
  }
  in_force_ = merged.settings;
  last_key_ = read.last_key;
  for (const std::string& key : merged.taken) lines.push_back("taken: " + key);
  for (const std::string& key : merged.for_a_restart) lines.push_back("needs a restart: " + key);
  if (lines.empty()) lines.emplace_back("the settings are as they were");
  return {true, lines};
}

}  // namespace deltamap::daemon
