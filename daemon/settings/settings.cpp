// SPDX-License-Identifier: Apache-2.0
#include "daemon/settings/settings.hpp"

#include <algorithm>
#include <cstdint>
#include <stdexcept>

#include "core/files/text_of_file.hpp"
#include "daemon/settings/fingerprint.hpp"
#include "daemon/settings/former_keys.hpp"
#include "daemon/settings/reader/settings_reader.hpp"
#include "daemon/settings/run_contradictions.hpp"
#include "daemon/settings/settings_reading.hpp"

namespace deltamap::daemon {
namespace {

enum class Use : std::uint8_t { kAny, kRun };

/// The key that stands last in the file, of those that no override replaces; empty where there is none.
std::string last_key_of_file(const ReadKeys& read) {
  std::string last;
  std::pair<int, int> last_place{0, 0};
  for (const auto& [key, place] : read.places) {
    const std::pair here{place.line, place.column};
    if (place.source != 0 || here < last_place) continue;
    last = key;
    last_place = here;
  }
  return last;
}

SettingsReading reading_of(const std::string& yaml, const std::string& name, const std::vector<std::string>& overrides,
                           Use use) {
  SettingsReading reading;
  const std::vector<SettingKey> keys = keys_of(reading.settings);
  SettingsReader reader{keys, former_keys()};
  reader.read_file(yaml, name);
  for (const std::string& text : overrides) reader.read_override(text);
  const auto add = [&](const std::vector<Contradiction>& contradictions) {
    for (const Contradiction& wrong : contradictions) reader.add_contradiction(wrong.key, wrong.what, wrong.others);
  };
  add(contradictions_in(reading.settings));
  if (use == Use::kRun) add(contradictions_in_a_run(reading.settings, name));
  reading.problems = reader.problems();
  for (const auto& [key, place] : reader.read().places) reading.given.insert(key);
  reading.doubtful = reader.read().doubtful;
  reading.is_whole = reader.read().is_whole;
  reading.file = name;
  reading.last_key = last_key_of_file(reader.read());
  reading.ends_its_line = yaml.empty() || yaml.back() == '\n';
  return reading;
}

std::string text_of_settings(const std::filesystem::path& file) {
  try {
    return text_of_file(file);
  } catch (const std::runtime_error& error) {
    throw SettingsError(file.string() + ": cannot read the settings: " + error.what());
  }
}

SettingsReading sound(SettingsReading reading) {
  if (!reading.problems.empty()) throw SettingsError(std::move(reading.problems));
  return reading;
}

}  // namespace

Settings parse_settings(const std::string& yaml, const std::string& name, const std::vector<std::string>& overrides) {
  return sound(reading_of(yaml, name, overrides, Use::kAny)).settings;
}

Settings read_settings(const std::filesystem::path& file, const std::vector<std::string>& overrides) {
  return parse_settings(text_of_settings(file), file.string(), overrides);
}

Settings settings_or_defaults(const std::string& file, const std::vector<std::string>& overrides) {
  return file.empty() ? parse_settings("", "--set", overrides) : read_settings(file, overrides);
}

SettingsReading look_at_settings(const std::filesystem::path& file, const std::vector<std::string>& overrides) {
  return reading_of(text_of_settings(file), file.string(), overrides, Use::kRun);
}

SettingsReading read_settings_of_a_run(const std::filesystem::path& file, const std::vector<std::string>& overrides) {
  return sound(look_at_settings(file, overrides));
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
