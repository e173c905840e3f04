// SPDX-License-Identifier: Apache-2.0
// The parts of the table of keys that lie in files of their own.
#pragma once

#include <vector>

#include "daemon/settings/settings.hpp"

namespace deltamap::daemon {

using Keys = std::vector<SettingKey>;

/// The key of `value` sets `other` to the same.
[[nodiscard]] SettingKey of_both(SettingKey key, const double& value, double& other);

void add_localization_keys(localization::LocalizerParams& localizer, Keys& keys);
void add_mapping_keys(MappingSettings& settings, Keys& keys);

}  // namespace deltamap::daemon
