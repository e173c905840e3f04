// SPDX-License-Identifier: Apache-2.0
// Why this process may not open a device, and who would have to do what about it: judged by the device's owner, group
// and mode.
#pragma once

#include <string>

namespace deltamap::drivers::port {

/// What a unit's `DeviceAllow=char-NAME rw` calls the driver of a character device, "ttyUSB"; empty where it is none,
/// or unknown (/proc/devices).
[[nodiscard]] std::string driver_of(const std::string& path);

/// What lets a service's unit open the device: "'DeviceAllow=char-ttyUSB rw' (sudo systemctl edit deltamap)".
[[nodiscard]] std::string way_past_the_unit(const std::string& path);

/// Why the unit of a running service does not let it open the device, whose mode allows it: the unit has no such line,
/// or the driver came after the start, for systemd looks up what a line names when it starts the service.
[[nodiscard]] std::string why_the_unit_forbids(const std::string& path);

/// "join the group 'dialout'", where its group may read and write and this user is not in it; else who may use it.
[[nodiscard]] std::string way_to_permission(const std::string& path);

}  // namespace deltamap::drivers::port
