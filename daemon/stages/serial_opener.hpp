// SPDX-License-Identifier: Apache-2.0
// Opens the serial devices where they are now.
#pragma once

#include "daemon/stages/device_link.hpp"
#include "drivers/port/port_finder.hpp"

namespace deltamap::daemon {

/// The finder must outlive the opener.
[[nodiscard]] PortOpener serial_opener(const drivers::port::PortFinder& finder);

}  // namespace deltamap::daemon
