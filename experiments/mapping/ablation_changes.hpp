// SPDX-License-Identifier: Apache-2.0
// What `ablation` changes, one thing a row: a mechanism switched off, or a key at half or twice its value.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "daemon/settings/settings.hpp"

namespace deltamap::experiments {

struct AblationChange {
  std::string name;  ///< "off-scan-break", "half-localization.particles.min"; fit for a file's name
  std::string what;  ///< what is changed, for a reader
  std::function<void(daemon::Settings&)> apply;
};

/// Mechanisms that have a switch, as a key or in their parameters.
[[nodiscard]] std::vector<AblationChange> switched_off(const daemon::Settings& delivered);
/// Every other key of localization and mapping at half and at twice its value, within its range; those of the method
/// that is not on are left out.
[[nodiscard]] std::vector<AblationChange> halved_and_doubled(const daemon::Settings& delivered);

}  // namespace deltamap::experiments
