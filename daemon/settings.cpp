// SPDX-License-Identifier: Apache-2.0
#include "daemon/settings.hpp"

#include <algorithm>
#include <stdexcept>

#include "core/text_of_file.hpp"
#include "daemon/fingerprint.hpp"
#include "daemon/settings_reader.hpp"

namespace deltamap::daemon {
Settings parse_settings(const std::string& yaml, const std::string& name, const std::vector<std::string>& overrides) {
  Settings settings;
  const std::vector<SettingKey> keys = keys_of(settings);
  SettingsReader reader{keys};
  reader.read_file(yaml, name);
  for (const std::string& text : overrides) reader.read_override(text);
  for (const Contradiction& wrong : contradictions_in(settings)) {
    reader.add_contradiction(wrong.key, wrong.what, wrong.others);
  }
  std::vector<std::string> problems = reader.problems();
  if (!problems.empty()) throw SettingsError(std::move(problems));
  return settings;
}

Settings read_settings(const std::filesystem::path& file, const std::vector<std::string>& overrides) {
  std::string text;
  try {
    text = text_of_file(file);
  } catch (const std::runtime_error& error) {
    throw SettingsError(file.string() + ": cannot read the settings: " + error.what());
  }
  return parse_settings(text, file.string(), overrides);
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
