// SPDX-License-Identifier: Apache-2.0
// A line that one thread says and others look at; empty: nothing to say. Changes seldom, so that a lock costs nobody
// anything.
#pragma once

#include <mutex>
#include <string>
#include <string_view>

namespace deltamap::daemon {

class Notice {
 public:
  /// By its only writer.
  void set(std::string_view line) {
    const std::scoped_lock lock{mutex_};
    if (line_ != line) line_ = line;
  }
  /// Any thread.
  [[nodiscard]] std::string line() const {
    const std::scoped_lock lock{mutex_};
    return line_;
  }

 private:
  mutable std::mutex mutex_;
  std::string line_;
};

}  // namespace deltamap::daemon
