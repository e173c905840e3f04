// SPDX-License-Identifier: Apache-2.0
// The configuration as documents, all written from the list of keys: a commented YAML file, a JSON schema for editors,
// and a page for people.
#pragma once

#include <string>

#include "daemon/settings/settings.hpp"

namespace deltamap::daemon {

/// All settings as a YAML file with unit, range and meaning of every key: --print-config and config/default.yaml.
[[nodiscard]] std::string settings_as_yaml(const Settings& settings);

/// JSON Schema 2020-12 of a settings file, with descriptions, ranges and defaults: --print-schema and
/// config/deltamap.schema.json. It takes keys one below the other, not the dotted names that the reader takes too.
[[nodiscard]] std::string settings_schema();

/// docs/configuration.md: a table for every section. --print-configuration-md.
[[nodiscard]] std::string settings_page();

}  // namespace deltamap::daemon
