// SPDX-License-Identifier: Apache-2.0
// What the live page may do beside looking: commands, which take the way of `deltamap ctl` through the control desk,
// and driving by hand. Without `dashboard.control` there is none of it.
#pragma once

#include <functional>
#include <string>

#include "daemon/control/server.hpp"
#include "daemon/dashboard/request.hpp"
#include "daemon/live/hand_drive.hpp"

namespace deltamap::daemon::control {
class ControlDesk;
}

namespace deltamap::daemon {

class IoStage;

struct PageControl {
  /// A line as on the control socket, and who wants the reply; empty: no control desk in this run.
  std::function<void(std::string line, control::Server::Reply reply)> ask{};
  Hand hand{};
};
/// `desk` may be null.
[[nodiscard]] PageControl page_control(control::ControlDesk* desk, IoStage& io);

/// Hands a command to the control desk. What moves the robot, or changes where it drives, is refused where the page
/// asks for no token.
void take_command(const PageControl& control, bool has_token, const dashboard::Request& request,
                  dashboard::Reply reply);

/// {"ok":false,"error":…} with this status.
[[nodiscard]] dashboard::Answer refused_command(unsigned status, const std::string& why);

}  // namespace deltamap::daemon
