// SPDX-License-Identifier: Apache-2.0
// The newest lines of the log, for whoever tells later what happened. Any thread.
#pragma once

#include <cstddef>
#include <deque>
#include <functional>
#include <mutex>
#include <string>
#include <utility>

#include "core/time.hpp"
#include "core/utc_text.hpp"

namespace deltamap::daemon {

class LogTail {
 public:
  static constexpr std::size_t kMostBytes = std::size_t{128} * 1024;

  void add(Timestamp time, const std::string& text, bool is_warning) {
    const std::scoped_lock lock{mutex_};
    lines_.push_back({time, utc_text(time) + (is_warning ? " warn " : " info ") + text + "\n"});
    bytes_ += lines_.back().text.size();
    for (; bytes_ > kMostBytes && lines_.size() > 1; lines_.pop_front()) bytes_ -= lines_.front().text.size();
  }
  /// A line each, with its time; oldest first.
  [[nodiscard]] std::string since(Timestamp time) const {
    const std::scoped_lock lock{mutex_};
    std::string all;
    for (const Line& line : lines_) {
      if (line.time >= time) all += line.text;
    }
    return all;
  }

 private:
  struct Line {
    Timestamp time;
    std::string text;
  };
  mutable std::mutex mutex_;
  std::deque<Line> lines_;
  std::size_t bytes_ = 0;
};

/// Tells a line, and keeps it in the tail, which must live as long. `now`: any thread.
[[nodiscard]] inline std::function<void(const std::string&)> heard_by(LogTail& tail, Timestamp (*now)(),
                                                                      std::function<void(const std::string&)> tell,
                                                                      bool is_warning) {
  return [&tail, now, tell = std::move(tell), is_warning](const std::string& text) {
    tail.add(now(), text, is_warning);
    tell(text);
  };
}

}  // namespace deltamap::daemon
