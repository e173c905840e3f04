// SPDX-License-Identifier: Apache-2.0
#include "simulation/devices/tcp_port.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <string>

#include "simulation/devices/serial_line.hpp"

namespace deltamap::simulation::devices {
namespace {

bool would_wait() { return errno == EAGAIN || errno == EWOULDBLOCK; }

}  // namespace

TcpPort::TcpPort(std::uint16_t number) : number_{number} {
  listener_ = ::socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  const int yes = 1;
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(number);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t length = sizeof address;
  auto* const any = reinterpret_cast<sockaddr*>(&address);
  if (listener_ < 0 || ::setsockopt(listener_, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes) != 0 ||
      ::bind(listener_, any, length) != 0 || ::listen(listener_, 1) != 0 ||
      ::getsockname(listener_, any, &length) != 0) {
    const std::string why = std::strerror(errno);
    if (listener_ >= 0) ::close(listener_);
    throw std::runtime_error("127.0.0.1:" + std::to_string(number) + ": " + why);
  }
  number_ = ntohs(address.sin_port);
}

TcpPort::~TcpPort() {
  hang_up();
  ::close(listener_);
}

unsigned TcpPort::baud() const { return kAnyBaud; }

void TcpPort::accept() {
  for (;;) {
    const int program = ::accept4(listener_, nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC);
    if (program < 0) return;
    if (program_ >= 0) {
      ::close(program);
      continue;
    }
    const int yes = 1;
    ::setsockopt(program, IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
    program_ = program;
  }
}

void TcpPort::hang_up() {
  if (program_ >= 0) ::close(program_);
  program_ = -1;
}

std::vector<std::uint8_t> TcpPort::read() {
  accept();
  std::vector<std::uint8_t> bytes;
  std::array<std::uint8_t, 512> chunk;
  while (program_ >= 0) {
    const ssize_t count = ::recv(program_, chunk.data(), chunk.size(), 0);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0 && would_wait()) break;
    if (count <= 0) {
      hang_up();
      break;
    }
    bytes.insert(bytes.end(), chunk.begin(), chunk.begin() + count);
  }
  return bytes;
}

void TcpPort::write(std::span<const std::uint8_t> bytes) {
  while (program_ >= 0 && !bytes.empty()) {
    const ssize_t count = ::send(program_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0 && would_wait()) return;
    if (count < 0) return hang_up();
    bytes = bytes.subspan(static_cast<std::size_t>(count));
  }
}

void TcpPort::watch(std::vector<pollfd>& watched) const {
  watched.push_back({listener_, POLLIN, 0});
  if (program_ >= 0) watched.push_back({program_, POLLIN, 0});
}

}  // namespace deltamap::simulation::devices
