// SPDX-License-Identifier: Apache-2.0
#include "drivers/port/port_clock.hpp"

namespace deltamap::drivers::port {
namespace {

Duration monotonic_now() {
  return std::chrono::duration_cast<Duration>(std::chrono::steady_clock::now().time_since_epoch());
}

}  // namespace

Timestamp port_clock_now() {
  static const Duration offset_to_unix =
      std::chrono::duration_cast<Duration>(std::chrono::system_clock::now().time_since_epoch()) - monotonic_now();
  return Timestamp{monotonic_now() + offset_to_unix};
}

}  // namespace deltamap::drivers::port
