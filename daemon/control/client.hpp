// SPDX-License-Identifier: Apache-2.0
// The other end of the control socket: one request, one reply.
#pragma once

#include <filesystem>
#include <string>

namespace deltamap::daemon::control {

/// Sends a line (without its line end) and answers the one that comes back; `drive off` is said again where the daemon
/// hangs up. Throws std::runtime_error with one line that names the socket: nobody listens, forbidden, no reply.
[[nodiscard]] std::string exchange(const std::filesystem::path& socket, const std::string& line);

}  // namespace deltamap::daemon::control
