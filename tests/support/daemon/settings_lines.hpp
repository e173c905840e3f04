// SPDX-License-Identifier: Apache-2.0
// What is told of the mistakes in a settings file called "f", a line each.
#pragma once

#include <string>
#include <vector>

#include "daemon/settings/settings.hpp"

namespace deltamap::test {

using Lines = std::vector<std::string>;

inline Lines errors_of(const std::string& yaml, const Lines& overrides = {}) {
  try {
    (void)daemon::parse_settings(yaml, "f", overrides);
  } catch (const daemon::SettingsError& error) {
    return error.lines();
  }
  return {};
}

}  // namespace deltamap::test
