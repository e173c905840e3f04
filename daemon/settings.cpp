// SPDX-License-Identifier: Apache-2.0
#include "daemon/settings.hpp"

#include <algorithm>
#include <stdexcept>

#include "core/text_of_file.hpp"
#include "daemon/fingerprint.hpp"
#include "daemon/settings_reader.hpp"

namespace deltamap::daemon {
namespace {

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
  SettingsReader reader{keys};
  reader.read_file(yaml, name);
  for (const std::string& text : overrides) reader.read_override(text);
  std::vector<std::string> problems = reader.problems();
  // Of values that were not taken nothing can be said together.
  if (problems.empty()) {
    for (const Contradiction& wrong : contradictions_in(settings)) {
      problems.push_back(reader.place_of(wrong.key, name) + ": " + wrong.what);
    }
  }
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
