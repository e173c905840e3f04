// SPDX-License-Identifier: Apache-2.0
// Why the daemon cannot start, where only a person can mend it: exit code 2, and systemd does not try again.
#pragma once

#include <stdexcept>

namespace deltamap::daemon {

/// One line that names the file or the key.
struct StartError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace deltamap::daemon
