// SPDX-License-Identifier: Apache-2.0
// Names that were keys once: a file that still has one is told what has become of it.
#pragma once

#include <map>
#include <string>

namespace deltamap::daemon {

/// Each with its new name, empty where its value is a constant of the model now.
[[nodiscard]] std::map<std::string, std::string> former_keys();

}  // namespace deltamap::daemon
