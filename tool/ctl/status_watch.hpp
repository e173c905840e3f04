// SPDX-License-Identifier: Apache-2.0
// `deltamap ctl status --watch`: the daemon's status line again and again, across its restarts.
#pragma once

#include <filesystem>
#include <iosfwd>

namespace deltamap::tool {

struct WatchOptions {
  std::filesystem::path socket;
  double period_s = 1.0;     ///< between two looks; > 0
  double patience_s = 60.0;  ///< for a daemon that has ended to come back
  bool as_json = false;      ///< one object a line, what goes wrong too
  bool on_terminal = false;  ///< the line is written over the one before
};

/// Until SIGINT or SIGTERM comes: that is no error. A daemon that ends and comes back is told of on `err`, as JSON on
/// `out`. Throws std::runtime_error with one line where no daemon answers at the beginning, where one that has ended
/// does not come back in time, or where `out` cannot be written.
void watch_status(const WatchOptions& options, std::ostream& out, std::ostream& err);

}  // namespace deltamap::tool
