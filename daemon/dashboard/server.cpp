// SPDX-License-Identifier: Apache-2.0
// The one source that includes Beast: its connections' headers are parts of it.
#include "daemon/dashboard/server.hpp"

#include <utility>  // Boost 1.74's awaitable.hpp needs it and does not say so

#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <vector>

#include "daemon/dashboard/driver.hpp"
#include "daemon/dashboard/http_connection.hpp"
#include "daemon/dashboard/listening_socket.hpp"
#include "daemon/dashboard/viewer.hpp"
#include "daemon/sockets/accept_loop.hpp"
#include "daemon/system/spare_descriptor.hpp"

namespace deltamap::daemon::dashboard {
namespace {

constexpr int kSendBuffer = 128 * 1024;          // of the kernel, for each connection
constexpr std::size_t kMostDrivers = 4;          // connections of /drive; one at a time has the robot
constexpr std::size_t kOthersDescriptors = 128;  // that the rest of this process needs: files, ports, sockets
constexpr std::size_t kFewestConnections = 8;

}  // namespace

struct Server::State {
  explicit State(Options given)
      : host{std::move(given), loop},
        clients{listening_socket(loop, host.options), [this](tcp::socket socket) { welcome(std::move(socket)); },
                [this] { return make_room(); }},
        period_timer{loop} {
    host.most = std::min(host.most, descriptors_beside(kOthersDescriptors, kFewestConnections));
    host.upgrade = [this](beast::tcp_stream stream, const HttpRequest& request, const Guest& guest) {
      const bool is_driver = request.target().starts_with(boost::string_view{kDrivePath.data(), kDrivePath.size()});
      is_driver ? welcome_driver(std::move(stream), request, guest) : welcome_viewer(std::move(stream), request, guest);
    };
  }
  ~State() { close(); }

  void welcome(tcp::socket socket) {
    const Guest guest{.from = owner_of(address_of(socket))};
    const Welcome verdict = welcome_for(guest.from, host.guests(), {host.most, host.options.most_from_one});
    if (!verdict.is_welcome) return;  // closed without an answer, which would hold its descriptor
    if (verdict.leaves != nullptr) host.send_away(verdict.leaves);
    error_code ignored;
    socket.set_option(tcp::no_delay(true), ignored);
    socket.set_option(asio::socket_base::send_buffer_size(kSendBuffer), ignored);
    const auto connection = std::make_shared<HttpConnection>(std::move(socket), guest, host);
    host.connections.insert(connection);
    connection->welcome();
  }

  /// Called where accept() finds no descriptor left: closes the connection that is first to leave.
  bool make_room() {
    const Guest* const leaves = first_to_leave(host.guests());
    if (leaves != nullptr) host.send_away(leaves);
    return leaves != nullptr;
  }

  /// Beyond the limit a viewer is let in only where it has shown the token and takes the place of one that has not.
  void welcome_viewer(beast::tcp_stream stream, const HttpRequest& request, const Guest& guest) {
    if (viewers.size() >= host.options.most_viewers) {
      std::vector<const Guest*> present;
      for (const Viewer* const viewer : viewers) present.push_back(&viewer->guest);
      const Guest* const leaves = first_to_leave(present);
      if (leaves == nullptr || leaves->is_known || !guest.is_known) return;
      host.send_away(leaves);
    }
    const auto viewer =
        std::make_shared<Viewer>(std::move(stream), guest, host, [this](Viewer* ended) { end_viewer(ended); });
    host.let_stand(viewer->guest, Standing::kViews);
    host.connections.insert(viewer);
    viewers.insert(viewer.get());
    if (viewers.size() == 1) {
      host.options.watched(true);
      host.options.refresh();
      next_period = Clock::now();
      wait_for_period();
    }
    viewer->welcome(request);
  }

  void welcome_driver(beast::tcp_stream stream, const HttpRequest& request, const Guest& guest) {
    if (drivers >= kMostDrivers) return;
    const auto driver = std::make_shared<Driver>(std::move(stream), guest, host, [this](Driver* ended) {
      const std::size_t before = host.connections.size();
      host.end(ended);
      drivers -= before - host.connections.size();
    });
    host.let_stand(driver->guest, Standing::kStays);
    host.connections.insert(driver);
    ++drivers;
    driver->welcome(request);
  }

  void end_viewer(Viewer* ended) {
    const std::size_t before = viewers.size();
    viewers.erase(ended);
    host.end(ended);
    if (before == 0 || !viewers.empty()) return;
    period_timer.cancel();
    host.options.watched(false);
  }

  void wait_for_period() {
    next_period = std::max(next_period + duration_of(host.options.period_s), Clock::now());
    period_timer.expires_at(next_period);
    period_timer.async_wait([this](const error_code& error) {
      if (error || viewers.empty()) return;
      host.options.refresh();
      const Clock::time_point now = Clock::now();
      const std::vector<Viewer*> present(viewers.begin(), viewers.end());
      for (Viewer* const viewer : present) {
        if (viewer->is_stuck(now)) {
          end_viewer(viewer);
        } else {
          viewer->serve();
        }
      }
      if (!viewers.empty()) wait_for_period();
    });
  }

  void close() {
    clients.close();
    period_timer.cancel();
    for (const auto& connection : host.connections) connection->close();
    host.connections.clear();
    host.turns.clear();
    viewers.clear();
    loop.stop();
  }

  asio::io_context loop{1};
  Host host;
  std::set<Viewer*> viewers;  // among the connections
  std::size_t drivers = 0;    // connections that may drive
  sockets::AcceptLoop<tcp> clients;
  asio::steady_timer period_timer;
  Clock::time_point next_period;
};

Server::Server(Options options) : state_{std::make_unique<State>(std::move(options))} {}
Server::~Server() = default;

std::uint16_t Server::port() const { return state_->clients.place().port(); }

std::string Server::place() const { return place_of(state_->clients.place()); }

void Server::run() {
  // However the loop ends, by an exception too, whoever drives by hand lets go of the robot.
  const std::unique_ptr<State, void (*)(State*)> at_end{state_.get(), [](State* state) { state->close(); }};
  const auto keep_alive = asio::make_work_guard(state_->loop);
  state_->clients.start();
  state_->loop.run();
}

void Server::stop() {
  state_->host.is_ending = true;
  asio::post(state_->loop, [this] { state_->close(); });
}

}  // namespace deltamap::daemon::dashboard
