// SPDX-License-Identifier: Apache-2.0
// What made a result: version, commit, and the settings in force. Stands in report.json and in each experiment's
// summary, so that a figure can be made again. What is not listed has its default at that commit.
#pragma once

#include <cinttypes>
#include <cstdio>
#include <string>

#include "daemon/settings/settings.hpp"
#include "daemon/telemetry/version.hpp"

namespace deltamap::daemon {

/// settings_fingerprint() as sixteen hex digits.
[[nodiscard]] inline std::string fingerprint_text(const Settings& settings) {
  char text[17];
  (void)std::snprintf(text, sizeof text, "%016" PRIx64, settings_fingerprint(settings));
  return text;
}

/// Adds `version`, `commit` and `settings` to a JSON object. Values that are JSON are kept as such.
template <typename Json>
void add_provenance(Json& json, const Settings& settings) {
  json["version"] = version();
  json["commit"] = commit();
  Json changed = Json::object();
  for (const auto& [key, value] : changed_settings(settings)) {
    changed[key] = Json::accept(value) ? Json::parse(value) : Json(value);
  }
  json["settings"] = {{"fingerprint", fingerprint_text(settings)}, {"changed", changed}};
}

}  // namespace deltamap::daemon
