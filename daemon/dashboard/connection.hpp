// SPDX-License-Identifier: Apache-2.0
// What all connections of the live page's server share. Included by server.cpp alone, as whatever includes Beast.
#pragma once

#include <utility>  // Boost 1.74's awaitable.hpp needs it and does not say so

#include <atomic>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http/message.hpp>
#include <boost/beast/http/string_body.hpp>
#include <chrono>
#include <memory>
#include <set>
#include <string>

#include "daemon/dashboard/server.hpp"

namespace deltamap::daemon::dashboard {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using boost::system::error_code;
using tcp = asio::ip::tcp;
using Clock = std::chrono::steady_clock;
using HttpRequest = http::request<http::string_body>;

inline constexpr std::chrono::seconds kHttpPatience{10};

inline Clock::duration duration_of(double time_s) {
  return std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(time_s));
}

/// A connection in the server's list; closing it ends whatever waits on it.
class Connection {
 public:
  Connection() = default;
  virtual ~Connection() = default;
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;
  virtual void close() = 0;
};

/// What connections may ask of the server's state.
struct Host {
  Server::Options options;
  std::atomic<bool> is_ending{false};  // what waits its turn is not answered any more
  std::set<std::shared_ptr<Connection>> connections{};
  /// Takes over a connection whose request is for a WebSocket, at /live or at /drive.
  std::function<void(beast::tcp_stream, const HttpRequest&)> upgrade{};

  void end(Connection* ended) {
    ended->close();
    std::erase_if(connections, [ended](const auto& connection) { return connection.get() == ended; });
  }
};

}  // namespace deltamap::daemon::dashboard
