// SPDX-License-Identifier: Apache-2.0
// Which outputs are being written, and since when and why one is not: for `deltamap ctl status`. Changes a few times in
// the life of a disk, so that a lock costs nobody anything.
#pragma once

#include <cstdint>
#include <mutex>
#include <string>
#include <vector>

#include "core/time.hpp"

namespace deltamap::daemon {

struct OutputStatus {
  std::string name;  ///< "trajectory", "store" …
  std::string file;
  bool written = true;
  Timestamp since;         ///< where it is not written: when that began
  std::string why;         ///< where it is not written: one line
  std::uint64_t lost = 0;  ///< lines or chunks that found no room while it was not written
};

class OutputBoard {
 public:
  /// Any thread. The newest word on the output of this name.
  void set(const OutputStatus& status) {
    const std::scoped_lock lock{mutex_};
    for (OutputStatus& known : outputs_) {
      if (known.name == status.name) {
        known = status;
        return;
      }
    }
    outputs_.push_back(status);
  }
  /// Any thread. In the order in which they came.
  [[nodiscard]] std::vector<OutputStatus> all() const {
    const std::scoped_lock lock{mutex_};
    return outputs_;
  }

 private:
  mutable std::mutex mutex_;
  std::vector<OutputStatus> outputs_;
};

}  // namespace deltamap::daemon
