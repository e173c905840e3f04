// SPDX-License-Identifier: Apache-2.0
// After a daemon that ended without a word (killed, crashed, without power): the minutes that its ring holds become an
// incident, or the end of the one that it was keeping.
#pragma once

#include <filesystem>
#include <functional>
#include <string>

namespace deltamap::daemon {

/// Moves the ring that another process has left out of the way of a new one; quick. Only the newest few are kept, so
/// that one that cannot be worked on is not met for ever. Throws std::runtime_error naming the folder.
void set_left_aside(const std::filesystem::path& parent);

/// What keep_left() tells.
struct KeptEnd {
  std::string line;  ///< for the log
  std::string name;  ///< of the incident; empty: none was kept
};
/// Makes incidents of what was set aside, and removes it; may be called again after it has thrown, or after the process
/// was killed in it. `own`: the name of an incident that this process is keeping, left alone; empty: none. Throws
/// std::runtime_error naming the file where the disk is full.
void keep_left(const std::filesystem::path& parent, const std::string& own,
               const std::function<void(const KeptEnd&)>& tell);

}  // namespace deltamap::daemon
