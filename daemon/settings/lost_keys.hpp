// SPDX-License-Identifier: Apache-2.0
// Whether a settings file that is read again still says what it said. An editor that was killed and a full disk leave
// an empty or a cut file behind, and every key that is not in it any more would be as delivered, which may be faster.
#pragma once

#include <string>
#include <vector>

#include "daemon/settings/settings_reading.hpp"

namespace deltamap::daemon {

/// A line for each loss: the file ends in the middle of a line; `last_key`, with which it ended before, is gone; a live
/// key would change only because nothing is said of it any more. Empty: it says all that it has to.
[[nodiscard]] std::vector<std::string> losses(const SettingsReading& read, const Settings& in_force,
                                              const std::string& last_key);

}  // namespace deltamap::daemon
