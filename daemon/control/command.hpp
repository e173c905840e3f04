// SPDX-License-Identifier: Apache-2.0
// What an operator asks of the localization thread while it runs. Taken before a scan and written into the recording
// with that scan's number and time, so that a replay repeats it. What changes the map is passed on as a MapOrder.
#pragma once

#include <cstdint>
#include <string>

#include "core/geometry/pose2.hpp"

namespace deltamap::daemon::control {

struct Command {
  enum class Kind : std::uint8_t {
    kPause,       ///< Δ-mapping sees no scan from now on
    kResume,      ///< and sees them again
    kRelocalize,  ///< the robot stands at map_from_robot
    kUndo,        ///< Δ `revision` is taken back
    kRollBack,    ///< the map is M_`revision` again
    kUndoThing,   ///< thing `thing` is taken back
    kSave         ///< map and pose on disk; changes nothing
  } kind = Kind::kSave;
  Pose2 map_from_robot;        ///< kRelocalize
  std::uint32_t revision = 0;  ///< kUndo, kRollBack
  std::uint32_t thing = 0;     ///< kUndoThing
  std::uint64_t ticket = 0;    ///< names the command in its CommandOutcome
};

/// What became of a command.
struct CommandOutcome {
  std::uint64_t ticket = 0;
  bool done = true;
  std::string message;  ///< one line: what was done, or why it could not be
  bool doubt = false;   ///< it was done, and a person should look at the message again
};

}  // namespace deltamap::daemon::control
