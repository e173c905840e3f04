// SPDX-License-Identifier: Apache-2.0
// Takes all clients that have come, on the loop of the acceptor that it is given. Where the process has no descriptor
// left, somebody is asked to leave for one who comes: a server that is full does not keep an order out. Where that
// fails too, it looks again a moment later: a server does not end by it.
#pragma once

#include <poll.h>

#include <boost/asio/error.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <functional>
#include <utility>

#include "daemon/system/spare_descriptor.hpp"

namespace deltamap::daemon::sockets {

template <typename Protocol>
class AcceptLoop {
 public:
  /// `welcome` is called on the loop for each client that has come. `make_room` ends a client, or answers false where
  /// none may be.
  AcceptLoop(
      typename Protocol::acceptor acceptor, std::function<void(typename Protocol::socket)> welcome,
      std::function<bool()> make_room = [] { return false; })
      : acceptor_{std::move(acceptor)},
        retry_timer_{acceptor_.get_executor()},
        welcome_{std::move(welcome)},
        make_room_{std::move(make_room)} {}

  void start() {
    boost::system::error_code ignored;
    acceptor_.non_blocking(true, ignored);
    wait();
  }
  /// Ends a client: what that frees is first of all for who comes next here.
  void end(const std::function<void()>& close_client) {
    const auto turn = SpareDescriptor::turn();
    close_client();
    spare_.hold();
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
  static constexpr int kMostAtOnce = 4;  // then they are heard, before others come for whom they might have to leave

  void wait() {
    acceptor_.async_wait(Protocol::acceptor::wait_read, [this](const boost::system::error_code& error) {
      if (!error) return take_all();
      if (error != boost::asio::error::operation_aborted) wait_later();
    });
  }

  /// Linux takes a descriptor before it looks whether anybody has come: without one, accept() fails the same where
  /// nobody waits, and whoever has just come would have to leave for him.
  [[nodiscard]] bool somebody_waits() {
    pollfd acceptor{acceptor_.native_handle(), POLLIN, 0};
    return ::poll(&acceptor, 1, 0) > 0;
  }

  void take_all() {
    namespace reason = boost::asio::error;
    for (int i = 0; i < kMostAtOnce && acceptor_.is_open() && somebody_waits(); ++i) {
      const auto turn = SpareDescriptor::turn();
      boost::system::error_code error;
      typename Protocol::socket socket = acceptor_.accept(error);
      if (!error) {
        welcome_(std::move(socket));
        spare_.hold();
        continue;
      }
      if (error == reason::would_block || error == reason::try_again) break;
      const bool is_full =
          error == reason::no_descriptors || error == boost::system::errc::too_many_files_open_in_system;
      if (!is_full || !(spare_.give() || make_room_())) return wait_later();
    }
    if (acceptor_.is_open()) wait();
  }

  void wait_later() {
    spare_.hold();
    retry_timer_.expires_after(kPauseAfterFailure);
    retry_timer_.async_wait([this](const boost::system::error_code& error) {
      if (!error) wait();
    });
  }

  typename Protocol::acceptor acceptor_;
  boost::asio::steady_timer retry_timer_;
  std::function<void(typename Protocol::socket)> welcome_;
  std::function<bool()> make_room_;
  SpareDescriptor spare_;
};

}  // namespace deltamap::daemon::sockets
