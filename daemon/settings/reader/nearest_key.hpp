// SPDX-License-Identifier: Apache-2.0
// What somebody may have meant by a key, or another name, that does not exist.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "daemon/settings/reader/setting_key.hpp"

namespace deltamap::daemon {

/// "laser", "laser.mount", …: everything that holds keys, in the order of the keys.
[[nodiscard]] std::vector<std::string> sections_of(const std::vector<SettingKey>& keys);

/// The name that is spelt most alike; nothing where more than half of the word would have to be written anew.
[[nodiscard]] std::optional<std::string> nearest_of(const std::vector<std::string>& names, const std::string& word);

struct UnknownKey {
  std::string rule;                ///< "unknown key (nearest key laser.port)"; names nothing that is not near
  std::vector<std::string> meant;  ///< the keys or sections that it names
};
/// Near is what is spelt alike; else what ends in the same name, in another section. Where keys stand below `path`,
/// sections are tried before keys.
[[nodiscard]] UnknownKey unknown_key(const std::vector<SettingKey>& keys, const std::string& path, bool has_keys_below);

}  // namespace deltamap::daemon
