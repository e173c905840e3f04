// SPDX-License-Identifier: Apache-2.0
#include "daemon/control/client.hpp"

#include <sys/socket.h>
#include <sys/time.h>
#include <sys/un.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>

#include "daemon/control/request.hpp"

namespace deltamap::daemon::control {
namespace {

constexpr timeval kPatience{3, 0};  // the daemon answers within a second; the rest is for a busy machine
constexpr int kMostStops = 20;      // a crowded daemon may close a connection before it has read the request

struct HungUp : std::runtime_error {
  using std::runtime_error::runtime_error;
};

struct Descriptor {
  int number = -1;
  explicit Descriptor(int opened) : number{opened} {}
  ~Descriptor() {
    if (number >= 0) ::close(number);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
};

class Connection {
 public:
  explicit Connection(const std::filesystem::path& path)
      : path_{path}, descriptor_{::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0)} {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    const std::string name = path.string();
    if (name.size() >= sizeof address.sun_path) refuse("the path is too long for a socket");
    std::memcpy(address.sun_path, name.data(), name.size());
    for (const int patience : {SO_RCVTIMEO, SO_SNDTIMEO}) {
      (void)::setsockopt(descriptor_.number, SOL_SOCKET, patience, &kPatience, sizeof kPatience);
    }
    if (::connect(descriptor_.number, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0) return;
    if (errno == EAGAIN) refuse("the daemon does not answer");
    if (errno == EACCES) refuse("forbidden (Permission denied): join the group of that socket");
    refuse(std::string("no daemon listens there (") + std::strerror(errno) + ")");
  }
  void send(const std::string& text) const {
    std::size_t sent = 0;
    while (sent < text.size()) {
      const ssize_t n = ::send(descriptor_.number, text.data() + sent, text.size() - sent, MSG_NOSIGNAL);
      if (n < 0 && errno == EINTR) continue;
      if (n < 0) return;  // the daemon may have said why before it hung up
      sent += static_cast<std::size_t>(n);
    }
  }

  [[nodiscard]] std::string line() const {
    std::string text;
    char bytes[4096];
    for (;;) {
      const ssize_t n = ::recv(descriptor_.number, bytes, sizeof bytes, 0);
      if (n < 0 && errno == EINTR) continue;
      if (n < 0 && (errno == EAGAIN || errno == EWOULDBLOCK)) refuse("the daemon does not answer");
      if (n <= 0) throw HungUp(path_.string() + ": the daemon hung up without a reply");
      text.append(bytes, static_cast<std::size_t>(n));
      if (const auto end = text.find('\n'); end != std::string::npos) return text.substr(0, end);
    }
  }

 private:
  [[noreturn]] void refuse(const std::string& why) const { throw std::runtime_error(path_.string() + ": " + why); }

  const std::filesystem::path& path_;
  Descriptor descriptor_;
};

}  // namespace

std::string exchange(const std::filesystem::path& socket, const std::string& line) {
  for (int tries_left = is_stop(line) ? kMostStops : 1;; --tries_left) {
    try {
      const Connection connection{socket};
      connection.send(line + "\n");
      return connection.line();
    } catch (const HungUp&) {
      if (tries_left <= 1) throw;
    }
  }
}

}  // namespace deltamap::daemon::control
