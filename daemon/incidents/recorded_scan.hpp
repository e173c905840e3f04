// SPDX-License-Identifier: Apache-2.0
// A scan out of the recorded bytes: what the laser saw at the moment of an incident.
#pragma once

#include <functional>
#include <optional>

#include "core/messages.hpp"
#include "daemon/settings/settings.hpp"
#include "drivers/port/byte_record.hpp"

namespace deltamap::daemon {

using TakeByteRecord = std::function<void(const drivers::port::ByteRecord&)>;

/// Of the scans in these records the one whose first beam is nearest to that time; nothing: there is none. `records`
/// hands over all of them, in order, with what the laser said of itself before the first scan.
[[nodiscard]] std::optional<Scan> recorded_scan(const Settings& settings, Timestamp time,
                                                const std::function<void(const TakeByteRecord&)>& records);

}  // namespace deltamap::daemon
