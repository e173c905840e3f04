// SPDX-License-Identifier: Apache-2.0
// What made a result: version, commit, and the settings in force. Stands in report.json and in each experiment's
// summary, so that a figure can be made again. What is not listed has its default at that commit.
#pragma once

#include "daemon/settings/fingerprint.hpp"
#include "daemon/settings/settings.hpp"
#include "daemon/telemetry/version.hpp"

namespace deltamap::daemon {

/// Adds `version`, `commit` and `settings` to a JSON object. Values that are JSON are kept as such.
template <typename Json>
void add_provenance(Json& json, const Settings& settings) {
  json["version"] = version();
  json["commit"] = commit();
  Json changed = Json::object();
  for (const auto& [key, value] : changed_settings(settings)) {
    changed[key] = Json::accept(value) ? Json::parse(value) : Json(value);
  }
  json["settings"] = {{"fingerprint", hex_of(settings_fingerprint(settings))}, {"changed", changed}};
}

}  // namespace deltamap::daemon
