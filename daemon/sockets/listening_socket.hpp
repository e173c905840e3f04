// SPDX-License-Identifier: Apache-2.0
// A Unix domain socket that listens, for owner and group. What a crash left at its path is replaced.
#pragma once

#include <utility>  // Boost 1.74's awaitable.hpp needs it and does not say so

#include <boost/asio/io_context.hpp>
#include <boost/asio/local/stream_protocol.hpp>
#include <filesystem>

#include "daemon/sockets/already_served.hpp"

namespace deltamap::daemon::sockets {

/// Throws AlreadyServed where somebody listens there, std::runtime_error with one line that names the path where nobody
/// could: a file that is no socket is in the way, the path is too long.
void require_way_clear(const std::filesystem::path& socket);

/// Throws as that does, and where it cannot listen: no such folder, forbidden.
[[nodiscard]] boost::asio::local::stream_protocol::acceptor listening_at(boost::asio::io_context& loop,
                                                                         const std::filesystem::path& socket);

/// The file of a socket that listens, removed with it. To be removed while it still listens: from then on a daemon that
/// follows may have made its own.
class SocketFile {
 public:
  explicit SocketFile(std::filesystem::path socket) : socket_{std::move(socket)} {}
  ~SocketFile() { remove(); }
  SocketFile(const SocketFile&) = delete;
  SocketFile& operator=(const SocketFile&) = delete;

  /// Once; later calls do nothing.
  void remove();

 private:
  std::filesystem::path socket_;  // empty: it is gone
};

/// Whether nobody is at the other end any more: both ways, for one that only has nothing more to say still listens.
[[nodiscard]] bool is_gone(boost::asio::local::stream_protocol::socket& socket);

}  // namespace deltamap::daemon::sockets
