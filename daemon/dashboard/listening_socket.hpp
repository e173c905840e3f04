// SPDX-License-Identifier: Apache-2.0
// Where the page's server listens: at an address and port of the settings, or on a socket that systemd hands over.
#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <string>

#include "daemon/dashboard/server.hpp"

namespace deltamap::daemon::dashboard {

/// Throws std::runtime_error with one line that names address and port: taken, or beyond this machine without a token.
[[nodiscard]] boost::asio::ip::tcp::acceptor listening_socket(boost::asio::io_context& loop,
                                                              const Server::Options& options);

/// "127.0.0.1:8484", "[::1]:8484"
[[nodiscard]] std::string place_of(const boost::asio::ip::tcp::endpoint& endpoint);

}  // namespace deltamap::daemon::dashboard
