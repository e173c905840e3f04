// SPDX-License-Identifier: Apache-2.0
#include "daemon/dashboard/listening_socket.hpp"

#include <netinet/tcp.h>
#include <sys/socket.h>

#include <boost/asio/ip/address.hpp>
#include <cstdint>
#include <stdexcept>

namespace deltamap::daemon::dashboard {
namespace {

namespace asio = boost::asio;

/// The acceptor of a listening socket that another process has opened, systemd for example.
asio::ip::tcp::acceptor inherited(asio::io_context& loop, int descriptor) {
  sockaddr_storage address{};
  socklen_t size = sizeof address;
  const bool is_socket = ::getsockname(descriptor, reinterpret_cast<sockaddr*>(&address), &size) == 0;
  if (!is_socket || (address.ss_family != AF_INET && address.ss_family != AF_INET6)) {
    throw std::runtime_error("the socket that was handed over is none of TCP");
  }
  return {loop, address.ss_family == AF_INET ? asio::ip::tcp::v4() : asio::ip::tcp::v6(), descriptor};
}

asio::ip::tcp::acceptor listening_at(asio::io_context& loop, const std::string& address, std::uint16_t port) {
  try {
    const asio::ip::tcp::endpoint endpoint{asio::ip::make_address(address), port};
    asio::ip::tcp::acceptor acceptor{loop, endpoint.protocol()};
    acceptor.set_option(asio::ip::tcp::acceptor::reuse_address(true));
    acceptor.bind(endpoint);
    acceptor.listen();
    return acceptor;
  } catch (const boost::system::system_error& error) {
    throw std::runtime_error(address + ":" + std::to_string(port) + ": cannot listen: " + error.code().message());
  }
}

}  // namespace

std::string place_of(const asio::ip::tcp::endpoint& endpoint) {
  const std::string address = endpoint.address().to_string();
  return (endpoint.address().is_v6() ? "[" + address + "]" : address) + ":" + std::to_string(endpoint.port());
}

asio::ip::tcp::acceptor listening_socket(asio::io_context& loop, const Server::Options& options) {
  asio::ip::tcp::acceptor acceptor =
      options.descriptor >= 0 ? inherited(loop, options.descriptor) : listening_at(loop, options.address, options.port);
  // The kernel keeps a connection back until its first bytes are there, a second at most: a viewer whose request is
  // still on its way does not count as silent, which would make it the first to be sent away.
  const int silence_s = 1;
  (void)::setsockopt(acceptor.native_handle(), IPPROTO_TCP, TCP_DEFER_ACCEPT, &silence_s, sizeof silence_s);
  const asio::ip::tcp::endpoint place = acceptor.local_endpoint();
  if (options.guard.token.empty() && !place.address().is_loopback()) {
    throw std::runtime_error(place_of(place) + ": leads beyond this machine, and no token is asked for");
  }
  return acceptor;
}

}  // namespace deltamap::daemon::dashboard
