// SPDX-License-Identifier: Apache-2.0
// Requests that only read are answered one after another, each after a pause as long as the one before has taken: an
// answer may take long, a picture of a large map for example, and no order waits for a queue of them. Included by
// server.cpp alone.
#pragma once

#include <utility>  // Boost 1.74's awaitable.hpp needs it and does not say so

#include <boost/asio/io_context.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <cstddef>
#include <deque>
#include <functional>

namespace deltamap::daemon::dashboard {

class AnswerTurns {
 public:
  explicit AnswerTurns(boost::asio::io_context& loop) : pause_{loop} {}

  /// `answer` is called when its turn comes.
  void add(std::function<void()> answer) {
    waiting_.push_back(std::move(answer));
    go_on();
  }
  /// Nobody is answered any more.
  void clear() {
    waiting_.clear();
    pause_.cancel();
  }
  /// So much is on its way to a client, and has ended. While it is much, no further answer is made: clients that do not
  /// take theirs cost no more memory.
  void began(std::size_t bytes) { on_the_way_ += bytes; }
  void ended(std::size_t bytes) {
    on_the_way_ -= bytes;
    go_on();
  }

 private:
  using Clock = boost::asio::steady_timer::clock_type;
  static constexpr std::size_t kMostOnTheWay = 16'000'000;  // bytes; one answer may be more

  void go_on() {
    if (is_called_ || waiting_.empty() || on_the_way_ > kMostOnTheWay) return;
    is_called_ = true;
    pause_.expires_at(not_before_);
    pause_.async_wait([this](const boost::system::error_code& error) {
      is_called_ = false;
      if (error || waiting_.empty()) return;
      const auto answer = std::move(waiting_.front());
      waiting_.pop_front();
      const Clock::time_point began = Clock::now();
      answer();
      const Clock::time_point ended = Clock::now();
      not_before_ = ended + (ended - began);
      go_on();
    });
  }

  boost::asio::steady_timer pause_;
  Clock::time_point not_before_{};
  std::deque<std::function<void()>> waiting_;
  std::size_t on_the_way_ = 0;
  bool is_called_ = false;
};

}  // namespace deltamap::daemon::dashboard
