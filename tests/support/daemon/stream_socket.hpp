// SPDX-License-Identifier: Apache-2.0
// A connected socket that waits at most two minutes for what it reads.
#pragma once

#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

#include <cerrno>
#include <string>
#include <utility>

namespace deltamap::test {

class StreamSocket {
 public:
  /// Of AF_UNIX, AF_INET. A receive buffer of 0 is the system's.
  explicit StreamSocket(int family, int receive_buffer = 0) : descriptor_{::socket(family, SOCK_STREAM, 0)} {
    const timeval patience{120, 0};
    (void)::setsockopt(descriptor_, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
    if (receive_buffer <= 0) return;
    (void)::setsockopt(descriptor_, SOL_SOCKET, SO_RCVBUF, &receive_buffer, sizeof receive_buffer);
  }
  ~StreamSocket() { vanish(); }
  StreamSocket(const StreamSocket&) = delete;
  StreamSocket& operator=(const StreamSocket&) = delete;

  template <typename Address>
  void connect(const Address& address) {
    is_connected_ = ::connect(descriptor_, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
  }
  [[nodiscard]] bool is_connected() const { return is_connected_; }

  /// False where the other side has hung up.
  bool send(const std::string& bytes) const {
    std::size_t sent = 0;
    while (sent < bytes.size()) {
      const ssize_t n = ::send(descriptor_, bytes.data() + sent, bytes.size() - sent, MSG_NOSIGNAL);
      if (n < 0 && errno == EINTR) continue;
      if (n <= 0) return false;
      sent += static_cast<std::size_t>(n);
    }
    return true;
  }
  /// What has come, at the end of `received`; false where the other side has hung up.
  bool receive(std::string& received) const {
    char bytes[4096];
    ssize_t n = 0;
    do {
      n = ::recv(descriptor_, bytes, sizeof bytes, 0);
    } while (n < 0 && errno == EINTR);  // this process was stopped and went on
    if (n > 0) received.append(bytes, static_cast<std::size_t>(n));
    return n > 0;
  }
  [[nodiscard]] int descriptor() const { return descriptor_; }
  void vanish() {
    if (descriptor_ >= 0) ::close(std::exchange(descriptor_, -1));
  }

 private:
  int descriptor_;
  bool is_connected_ = false;
};

}  // namespace deltamap::test
