// SPDX-License-Identifier: Apache-2.0
// What systemd hears of the daemon (sd_notify(3)). Without systemd every call does nothing.
#pragma once

#include <chrono>
#include <optional>
#include <string>

#include "core/time.hpp"

namespace deltamap::daemon::service {

void tell_ready();
/// Before what may take long at a start: systemd waits so long from now on, and no shorter than it would.
void ask_for_time(std::chrono::seconds time);
/// Until tell_ready().
void tell_reloading();
void tell_stopping();
void tell_status(const std::string& line);
/// To be called more often than watchdog_period() while everything moves.
void feed_watchdog();
/// The socket of this name that systemd has opened for us (FileDescriptorName=), or -1.
[[nodiscard]] int handed_over_socket(const std::string& name);
/// Nothing where no watchdog waits for us.
[[nodiscard]] std::optional<Duration> watchdog_period();

}  // namespace deltamap::daemon::service
