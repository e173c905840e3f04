// SPDX-License-Identifier: Apache-2.0
// A client of the control socket that may be as rude as a test needs it.
#pragma once

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstring>
#include <filesystem>
#include <string>
#include <utility>

namespace deltamap::test {

class SocketClient {
 public:
  explicit SocketClient(const std::filesystem::path& path) : descriptor_{::socket(AF_UNIX, SOCK_STREAM, 0)} {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    std::strncpy(address.sun_path, path.c_str(), sizeof address.sun_path - 1);
    const timeval patience{20, 0};
    (void)::setsockopt(descriptor_, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
    is_connected_ = ::connect(descriptor_, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
  }
  ~SocketClient() { vanish(); }
  SocketClient(const SocketClient&) = delete;
  SocketClient& operator=(const SocketClient&) = delete;

  [[nodiscard]] bool is_connected() const { return is_connected_; }

  /// False where the other side has hung up.
  bool send(const std::string& bytes) const {
    std::size_t sent = 0;
    while (sent < bytes.size()) {
      const ssize_t n = ::send(descriptor_, bytes.data() + sent, bytes.size() - sent, MSG_NOSIGNAL);
      if (n <= 0) return false;
      sent += static_cast<std::size_t>(n);
    }
    return true;
  }

  /// The next line; what came before the end where the other side hangs up.
  [[nodiscard]] std::string line() {
    for (;;) {
      if (const auto end = received_.find('\n'); end != std::string::npos) {
        std::string line = received_.substr(0, end);
        received_.erase(0, end + 1);
        return line;
      }
      char bytes[512];
      const ssize_t n = ::recv(descriptor_, bytes, sizeof bytes, 0);
      if (n <= 0) return std::exchange(received_, {});
      received_.append(bytes, static_cast<std::size_t>(n));
    }
  }

  [[nodiscard]] std::string asked(const std::string& request) {
    (void)send(request + "\n");
    return line();
  }

  void vanish() {
    if (descriptor_ >= 0) ::close(std::exchange(descriptor_, -1));
  }

 private:
  int descriptor_;
  bool is_connected_ = false;
  std::string received_;
};

}  // namespace deltamap::test
