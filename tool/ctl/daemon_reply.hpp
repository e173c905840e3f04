// SPDX-License-Identifier: Apache-2.0
// What the running daemon has answered to a request of the tool.
#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>

#include "daemon/control/request.hpp"

namespace deltamap::tool {

struct DaemonReply {
  bool ok = true;
  std::string line;            ///< the reply as it came: JSON, without its line end
  std::string words;           ///< for a person: what was done, or why it could not be
  std::string status_line;     ///< of a status; else empty
  double since_start_s = 0.0;  ///< of a status: how long the daemon has run
};

/// Asks and waits for the answer. Throws std::runtime_error with one line that names the socket: nobody listens,
/// forbidden, no reply, or none that a daemon of ours gives.
[[nodiscard]] DaemonReply reply_to(const daemon::control::Request& request, const std::filesystem::path& socket);

}  // namespace deltamap::tool
