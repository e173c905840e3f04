// SPDX-License-Identifier: Apache-2.0
#include "simulation/devices/tcp_port.hpp"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <stdexcept>

#include "simulation/devices/serial_line.hpp"

namespace deltamap::simulation::devices {
namespace {

/// A program at the other end.
class Program {
 public:
  explicit Program(const TcpPort& port) : socket_{::socket(AF_INET, SOCK_STREAM, 0)} {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(port.number());
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    EXPECT_EQ(::connect(socket_, reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
  }
  ~Program() { ::close(socket_); }
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

  void say(std::span<const std::uint8_t> bytes) const {
    EXPECT_EQ(::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL), static_cast<ssize_t>(bytes.size()));
  }
  /// Waits for something; empty: the port has hung up.
  [[nodiscard]] std::vector<std::uint8_t> heard() const {
    std::vector<std::uint8_t> bytes(64);
    const ssize_t count = ::recv(socket_, bytes.data(), bytes.size(), 0);
    bytes.resize(static_cast<std::size_t>(std::max<ssize_t>(0, count)));
    return bytes;
  }

 private:
  int socket_;
};

void wait_for(const TcpPort& port) {
  constexpr int kPatience_ms = 5000;
  std::vector<pollfd> watched;
  port.watch(watched);
  ASSERT_GT(::poll(watched.data(), watched.size(), kPatience_ms), 0);
}

const std::vector<std::uint8_t> kAll{0x00, 0x03, 0x0A, 0x0D, 0x11, 0x13, 0xFF};

TEST(TcpPort, CarriesBytesBothWays) {
  TcpPort port{0};
  EXPECT_EQ(port.baud(), kAnyBaud);
  port.write(kAll);  // nobody listens: lost
  const Program program{port};
  wait_for(port);
  EXPECT_TRUE(port.read().empty());
  EXPECT_TRUE(port.is_open_elsewhere());
  port.write(kAll);
  EXPECT_EQ(program.heard(), kAll);
  program.say(kAll);
  wait_for(port);
  EXPECT_EQ(port.read(), kAll);
}

TEST(TcpPort, TurnsASecondProgramAwayAndTakesTheNextOneWhenTheFirstHasGone) {
  TcpPort port{0};
  {
    const Program first{port};
    wait_for(port);
    (void)port.read();
    const Program second{port};
    wait_for(port);
    (void)port.read();
    EXPECT_TRUE(second.heard().empty());
    port.write(kAll);
    EXPECT_EQ(first.heard(), kAll);
  }
  wait_for(port);
  (void)port.read();
  EXPECT_FALSE(port.is_open_elsewhere());
  const Program third{port};
  wait_for(port);
  (void)port.read();
  port.write(kAll);
  EXPECT_EQ(third.heard(), kAll);
}

TEST(TcpPort, NamesAPortThatIsTaken) {
  const TcpPort port{0};
  try {
    const TcpPort again{port.number()};
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_TRUE(std::string(error.what()).starts_with("127.0.0.1:" + std::to_string(port.number()))) << error.what();
  }
}

}  // namespace
}  // namespace deltamap::simulation::devices
