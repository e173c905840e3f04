// SPDX-License-Identifier: Apache-2.0
#include "daemon/settings/settings.hpp"

#include <algorithm>
#include <stdexcept>

#include "core/text_of_file.hpp"
#include "daemon/settings/fingerprint.hpp"
#include "daemon/settings/former_keys.hpp"
#include "daemon/settings/reader/settings_reader.hpp"
#include "daemon/settings/settings_reading.hpp"

namespace deltamap::daemon {
namespace {

SettingsReading reading_of(const std::string& yaml, const std::string& name,
                           const std::vector<std::string>& overrides) {
  SettingsReading reading;
  const std::vector<SettingKey> keys = keys_of(reading.settings);
  SettingsReader reader{keys, former_keys()};
  reader.read_file(yaml, name);
  for (const std::string& text : overrides) reader.read_override(text);
  for (const Contradiction& wrong : contradictions_in(reading.settings)) {
    reader.add_contradiction(wrong.key, wrong.what, wrong.others);
  }
  reading.problems = reader.problems();
  for (const auto& [key, place] : reader.read().places) reading.given.insert(key);
  reading.doubtful = reader.read().doubtful;
  reading.is_whole = reader.read().is_whole;
  return reading;
}

std::string text_of_settings(const std::filesystem::path& file) {
  try {
    return text_of_file(file);
  } catch (const std::runtime_error& error) {
    throw SettingsError(file.string() + ": cannot read the settings: " + error.what());
  }
}

}  // namespace

Settings parse_settings(const std::string& yaml, const std::string& name, const std::vector<std::string>& overrides) {
  SettingsReading reading = reading_of(yaml, name, overrides);
  if (!reading.problems.empty()) throw SettingsError(std::move(reading.problems));
  return std::move(reading.settings);
}

Settings read_settings(const std::filesystem::path& file, const std::vector<std::string>& overrides) {
  return parse_settings(text_of_settings(file), file.string(), overrides);
}

SettingsReading look_at_settings(const std::filesystem::path& file, const std::vector<std::string>& overrides) {
  return reading_of(text_of_settings(file), file.string(), overrides);
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
