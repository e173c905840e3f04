// SPDX-License-Identifier: Apache-2.0
// A client of the control socket that may be as rude as a test needs it.
#pragma once

#include <gtest/gtest.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstring>
#include <filesystem>
#include <string>
#include <utility>

#include "tests/support/daemon/stream_socket.hpp"

namespace deltamap::test {

inline sockaddr_un address_of(const std::filesystem::path& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  std::strncpy(address.sun_path, path.c_str(), sizeof address.sun_path - 1);
  return address;
}

/// As a crash does: the socket's file is there, and nobody listens.
inline void leave_socket_behind(const std::filesystem::path& path) {
  const int left = ::socket(AF_UNIX, SOCK_STREAM, 0);
  const sockaddr_un address = address_of(path);
  ASSERT_EQ(::bind(left, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  ::close(left);
}

class SocketClient {
 public:
  explicit SocketClient(const std::filesystem::path& path) : socket_{AF_UNIX} { connect(path); }
  /// Has its descriptor, and connects later.
  SocketClient() : socket_{AF_UNIX} {}
  void connect(const std::filesystem::path& path) { socket_.connect(address_of(path)); }

  [[nodiscard]] bool is_connected() const { return socket_.is_connected(); }

  /// False where the other side has hung up.
  bool send(const std::string& bytes) const { return socket_.send(bytes); }

  /// The next line; what came before the end where the other side hangs up.
  [[nodiscard]] std::string line() {
    for (;;) {
      if (const auto end = received_.find('\n'); end != std::string::npos) {
        std::string line = received_.substr(0, end);
        received_.erase(0, end + 1);
        return line;
      }
      if (!socket_.receive(received_)) return std::exchange(received_, {});
    }
  }

  [[nodiscard]] std::string asked(const std::string& request) {
    (void)send(request + "\n");
    return line();
  }

  /// Still listens.
  void say_no_more() const { (void)::shutdown(socket_.descriptor(), SHUT_WR); }
  void vanish() { socket_.vanish(); }

 private:
  StreamSocket socket_;
  std::string received_;
};

}  // namespace deltamap::test
