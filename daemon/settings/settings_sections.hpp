// SPDX-License-Identifier: Apache-2.0
// What each section of the configuration is about: the headings of config/default.yaml, docs/configuration.md and the
// JSON schema.
#pragma once

#include <string>
#include <vector>

namespace deltamap::daemon {

struct SettingSection {
  std::string name;     ///< "laser.mount"
  std::string meaning;  ///< one line that stands alone
};

/// One for every section of the keys, a section before those within it.
[[nodiscard]] const std::vector<SettingSection>& setting_sections();

/// The meaning of a section; empty where there is none of that name.
[[nodiscard]] std::string meaning_of_section(const std::string& name);

}  // namespace deltamap::daemon
