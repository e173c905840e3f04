// SPDX-License-Identifier: Apache-2.0
// What all connections of the live page's server share. Included by server.cpp alone, as whatever includes Beast.
#pragma once

#include <utility>  // Boost 1.74's awaitable.hpp needs it and does not say so

#include <algorithm>
#include <atomic>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http/message.hpp>
#include <boost/beast/http/string_body.hpp>
#include <chrono>
#include <functional>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "daemon/dashboard/answer_turns.hpp"
#include "daemon/dashboard/places.hpp"
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
  explicit Connection(Guest who) : guest{std::move(who)} {}
  virtual ~Connection() = default;
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;
  virtual void close() = 0;
  /// Closed, and not in the list any more.
  virtual void leave() = 0;

  Guest guest;
};

/// What connections may ask of the server's state.
struct Host {
  Host(Server::Options given, boost::asio::io_context& loop) : options{std::move(given)}, turns{loop} {}

  Server::Options options;
  std::atomic<bool> is_ending{false};  // what waits its turn is not answered any more
  std::set<std::shared_ptr<Connection>> connections{};
  AnswerTurns turns;                            // of requests that read
  std::size_t commands = 0;                     // that wait for their reply, STOP not counted
  std::size_t most = options.most_connections;  // as far as this process has descriptors
  std::uint64_t next_guest = 0;                 // counts changes of standing
  /// Takes over a connection whose request is for a WebSocket, at /live or at /drive.
  std::function<void(beast::tcp_stream, const HttpRequest&, const Guest&)> upgrade{};

  /// Commands stay for their reply: never so many that nobody could leave for a STOP.
  [[nodiscard]] std::size_t most_commands() const { return std::max<std::size_t>(1, most / 6); }
  [[nodiscard]] std::vector<const Guest*> guests() const {
    std::vector<const Guest*> all;
    for (const auto& connection : connections) all.push_back(&connection->guest);
    return all;
  }
  void let_stand(Guest& guest, Standing standing) {
    guest.standing = standing;
    guest.since = next_guest++;
  }
  void send_away(const Guest* guest) {
    const auto found = std::find_if(connections.begin(), connections.end(),
                                    [guest](const auto& connection) { return &connection->guest == guest; });
    if (found == connections.end()) return;
    const std::shared_ptr<Connection> leaving = *found;
    leaving->leave();
  }
  void end(Connection* ended) {
    ended->close();
    std::erase_if(connections, [ended](const auto& connection) { return connection.get() == ended; });
  }
};

}  // namespace deltamap::daemon::dashboard
