// SPDX-License-Identifier: Apache-2.0
#include "daemon/system/service.hpp"

#include <systemd/sd-daemon.h>

#include <cstdlib>

namespace deltamap::daemon::service {

void tell_ready() { (void)sd_notify(0, "READY=1"); }
void ask_for_time(std::chrono::seconds time) {
  const auto time_us = std::chrono::microseconds(time).count();
  (void)sd_notify(0, ("EXTEND_TIMEOUT_USEC=" + std::to_string(time_us)).c_str());
}
void tell_reloading() { (void)sd_notify(0, "RELOADING=1"); }
void tell_stopping() { (void)sd_notify(0, "STOPPING=1"); }
void tell_status(const std::string& line) { (void)sd_notify(0, ("STATUS=" + line).c_str()); }
void feed_watchdog() { (void)sd_notify(0, "WATCHDOG=1"); }

int handed_over_socket(const std::string& name) {
  char** names = nullptr;
  const int count = sd_listen_fds_with_names(0, &names);
  int found = -1;
  for (int i = 0; i < count; ++i) {
    if (found < 0 && name == names[i]) found = SD_LISTEN_FDS_START + i;
    std::free(names[i]);
  }
  std::free(names);
  return found;
}

std::optional<Duration> watchdog_period() {
  std::uint64_t period_us = 0;
  if (sd_watchdog_enabled(0, &period_us) <= 0) return std::nullopt;
  return std::chrono::microseconds{period_us};
}

}  // namespace deltamap::daemon::service
