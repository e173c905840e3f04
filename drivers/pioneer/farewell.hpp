// SPDX-License-Identifier: Apache-2.0
// The last that a session says to a robot: ESTOP, VEL 0, RVEL 0, and CLOSE once it stands.
//
// CLOSE takes the current from the motors and our deceleration from the controller: a robot that still moves then rolls
// on, so one that would move for long is not closed. Only a robot that we have opened hears CLOSE, one that waits for a
// connection may take it amiss; and only at our own wish: where the link has failed, the SIPs of the connection that is
// left over will tell what buttons were pressed meanwhile, and CLOSE would wipe that out.
#pragma once

#include <optional>
#include <string>

#include "core/time.hpp"
#include "drivers/pioneer/transmitter.hpp"

namespace deltamap::drivers::pioneer {

class Farewell {
 public:
  /// The link has failed, and why.
  void begin_after_failure(std::string reason, Transmitter& line);
  /// At our own wish.
  void begin(bool has_opened, Transmitter& line);

  /// CLOSE waits in the queue from now on; false: it is not due, or not owed.
  [[nodiscard]] bool pushes_close(Transmitter& line);
  [[nodiscard]] bool is_over(const CommandQueue& commands) const { return commands.is_empty() && !owes_close_; }
  /// When CLOSE is due.
  [[nodiscard]] Timestamp deadline() const { return close_at_; }
  /// Why the session has failed; nothing: it was closed.
  [[nodiscard]] const std::optional<std::string>& reason() const { return reason_; }

 private:
  std::optional<std::string> reason_;
  bool owes_close_ = false;
  Timestamp close_at_;
};

}  // namespace deltamap::drivers::pioneer
