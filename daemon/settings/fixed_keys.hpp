// SPDX-License-Identifier: Apache-2.0
// Names that were keys once and are constants of the model now: a file that still has one is told so.
#pragma once

#include <string>
#include <vector>

namespace deltamap::daemon {

[[nodiscard]] std::vector<std::string> fixed_keys();

}  // namespace deltamap::daemon
