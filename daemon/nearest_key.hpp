// SPDX-License-Identifier: Apache-2.0
// What somebody may have meant by a key that does not exist.
#pragma once

#include <string>
#include <vector>

#include "daemon/setting_key.hpp"

namespace deltamap::daemon {

/// "laser", "laser.mount", …: everything that holds keys, in the order of the keys.
[[nodiscard]] std::vector<std::string> sections_of(const std::vector<SettingKey>& keys);

/// "unknown key 'laser.prot'; the nearest known key is 'laser.port'". Where keys stand below `path`, sections are
/// tried before keys. Names nothing that is not near.
[[nodiscard]] std::string unknown_key_line(const std::vector<SettingKey>& keys, const std::string& path,
                                           bool has_keys_below);

}  // namespace deltamap::daemon
