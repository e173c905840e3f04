// SPDX-License-Identifier: Apache-2.0
// The localizers that experiments compare: as the peers were measured, and as the daemon is delivered.
#pragma once

#include <string>
#include <vector>

#include "localization/localizer_params.hpp"

namespace deltamap::experiments {

struct LocalizerVariant {
  std::string name;
  localization::LocalizerParams params;
};

/// "500x60": 500 particles and 60 beams; "delivered": the settings as they are given.
[[nodiscard]] std::vector<LocalizerVariant> localizer_variants(const localization::LocalizerParams& given);

}  // namespace deltamap::experiments
