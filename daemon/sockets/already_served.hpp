// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>

namespace deltamap::daemon::sockets {

/// Another daemon listens at this path: one line that names it.
class AlreadyServed : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace deltamap::daemon::sockets
