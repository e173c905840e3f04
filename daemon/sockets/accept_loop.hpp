// SPDX-License-Identifier: Apache-2.0
// Takes one client after another, on the loop of the acceptor that it is given. Where that fails, for want of a
// descriptor for example, it looks again a moment later: a server does not end by it.
#pragma once

#include <boost/asio/error.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <functional>
#include <utility>

namespace deltamap::daemon::sockets {

template <typename Protocol>
class AcceptLoop {
 public:
  /// `welcome` is called on the loop for each client that has come.
  AcceptLoop(typename Protocol::acceptor acceptor, std::function<void(typename Protocol::socket)> welcome)
      : acceptor_{std::move(acceptor)}, retry_timer_{acceptor_.get_executor()}, welcome_{std::move(welcome)} {}

  void start() {
    acceptor_.async_accept([this](const boost::system::error_code& error, typename Protocol::socket socket) {
      if (error == boost::asio::error::operation_aborted) return;
      if (error) return start_later();
      welcome_(std::move(socket));
      start();
    });
  }
  /// Nobody is welcome any more.
  void close() {
    boost::system::error_code ignored;
    acceptor_.close(ignored);
    retry_timer_.cancel();
  }

  [[nodiscard]] typename Protocol::endpoint place() const { return acceptor_.local_endpoint(); }

 private:
  static constexpr std::chrono::milliseconds kPauseAfterFailure{200};

  void start_later() {
    retry_timer_.expires_after(kPauseAfterFailure);
    retry_timer_.async_wait([this](const boost::system::error_code& error) {
      if (!error) start();
    });
  }

  typename Protocol::acceptor acceptor_;
  boost::asio::steady_timer retry_timer_;
  std::function<void(typename Protocol::socket)> welcome_;
};

}  // namespace deltamap::daemon::sockets
