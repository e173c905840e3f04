// SPDX-License-Identifier: Apache-2.0
#include "daemon/sockets/listening_socket.hpp"

#include <poll.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include <string>
#include <system_error>

namespace deltamap::daemon::sockets {
namespace {

namespace asio = boost::asio;
using Protocol = asio::local::stream_protocol;
using boost::system::error_code;

constexpr mode_t kOwnerAndGroup = 0660;

[[noreturn]] void refuse(const std::filesystem::path& socket, const std::string& why) {
  throw std::runtime_error(socket.string() + ": cannot listen: " + why);
}

}  // namespace

void require_way_clear(const std::filesystem::path& socket) {
  std::error_code ignored;
  try {
    const Protocol::endpoint endpoint{socket.string()};  // throws where the path is too long
    const auto status = std::filesystem::symlink_status(socket, ignored);
    if (!std::filesystem::exists(status)) return;
    if (!std::filesystem::is_socket(status)) refuse(socket, "a file that is no socket is in the way");
    asio::io_context loop;
    Protocol::socket caller{loop};
    error_code error;
    caller.connect(endpoint, error);
    if (!error || error == asio::error::try_again || error == asio::error::would_block) {
      throw AlreadyServed(socket.string() + ": another daemon listens there");
    }
    if (error != asio::error::connection_refused) refuse(socket, error.message());
  } catch (const boost::system::system_error& error) {
    refuse(socket, error.code().message());
  }
}

/// Opens a listening socket for owner and group: fchmod() before bind() keeps it from being wider for a moment, chmod()
/// after it undoes a narrower umask.
Protocol::acceptor listening_at(asio::io_context& loop, const std::filesystem::path& socket) {
  try {
    require_way_clear(socket);
    std::error_code ignored;
    std::filesystem::remove(socket, ignored);
    const Protocol::endpoint endpoint{socket.string()};
    Protocol::acceptor acceptor{loop, Protocol{}};
    (void)::fchmod(acceptor.native_handle(), kOwnerAndGroup);
    acceptor.bind(endpoint);
    if (::chmod(socket.c_str(), kOwnerAndGroup) != 0) refuse(socket, "its permissions cannot be set");
    acceptor.listen();
    return acceptor;
  } catch (const boost::system::system_error& error) {
    refuse(socket, error.code().message());
  }
}

void SocketFile::remove() {
  std::error_code ignored;
  if (!socket_.empty()) std::filesystem::remove(socket_, ignored);
  socket_.clear();
}

bool is_gone(Protocol::socket& socket) {
  pollfd state{socket.native_handle(), 0, 0};
  return ::poll(&state, 1, 0) > 0 && (state.revents & POLLHUP) != 0;
}

}  // namespace deltamap::daemon::sockets
