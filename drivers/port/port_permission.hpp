// SPDX-License-Identifier: Apache-2.0
// Why this process may not open a device, and who would have to do what about it: judged by the device's owner, group
// and mode.
#pragma once

#include <string>

namespace deltamap::drivers::port {

/// "join the group 'dialout'", where its group may read and write and this user is not in it; else who may use it.
[[nodiscard]] std::string way_to_permission(const std::string& path);

}  // namespace deltamap::drivers::port
