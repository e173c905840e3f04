// SPDX-License-Identifier: Apache-2.0
// Why the daemon cannot start, where only a person can mend it: exit code 2, and systemd does not try again.
#pragma once

#include <stdexcept>
#include <system_error>

namespace deltamap::daemon {

/// One line that names the file or the key.
struct StartError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// What this user may not do with a file at the start, waiting does not mend.
template <class Work>
auto or_start_error(Work&& work) {
  try {
    return work();
  } catch (const std::system_error& error) {
    throw StartError(error.what());
  }
}

}  // namespace deltamap::daemon
