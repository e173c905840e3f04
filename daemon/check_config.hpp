// SPDX-License-Identifier: Apache-2.0
// --check-config: what a start would find, without starting. Reads the map whole, opens a copy of the store, looks at
// the ports from outside. Makes, changes and disturbs nothing. Outputs are judged as a start judges them
// (output_place).
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "daemon/settings/settings.hpp"
#include "daemon/settings/settings_reading.hpp"

namespace deltamap::daemon {

struct Finding {
  enum class Level : std::uint8_t { kOk, kWarning, kError } level = Level::kOk;
  std::string about;  ///< "map", "store", "robot", …
  std::string text;   ///< one line
};

/// In the order of a start. An absent device is a warning: the daemon waits for it. An error: it could not start, or
/// would wait for what only a person can mend. `out` is the folder of --out; empty: none.
[[nodiscard]] std::vector<Finding> check_config(const Settings& settings, const std::string& config,
                                                const std::string& out);

/// The same of settings with mistakes, as far as what a key means is known: map and ports.
[[nodiscard]] std::vector<Finding> check_what_is_read(const SettingsReading& reading, const std::string& config);

/// What the systemd unit would keep from these settings: told of settings in /etc/deltamap, which are its own.
[[nodiscard]] std::vector<Finding> what_the_service_may_not(const Settings& settings);

[[nodiscard]] bool has_error(const std::vector<Finding>& findings);

/// A line each, and one that sums up.
[[nodiscard]] std::string text_of(const std::vector<Finding>& findings);

}  // namespace deltamap::daemon
