// SPDX-License-Identifier: Apache-2.0
#include "daemon/control/server.hpp"

#include <utility>  // Boost 1.74's awaitable.hpp needs it and does not say so

#include <algorithm>
#include <boost/asio/buffer.hpp>
#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/local/stream_protocol.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/read_until.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/write.hpp>
#include <chrono>
#include <optional>
#include <set>

#include "daemon/control/request.hpp"
#include "daemon/sockets/accept_loop.hpp"
#include "daemon/sockets/listening_socket.hpp"
#include "daemon/system/spare_descriptor.hpp"

namespace deltamap::daemon::control {
namespace {

namespace asio = boost::asio;
using Protocol = asio::local::stream_protocol;
using boost::system::error_code;

constexpr std::size_t kMostClients = 64;
constexpr std::size_t kFewestClients = 16;
constexpr std::size_t kOthersDescriptors = 64;  // files, ports and the first connections of the page

/// One client: a line, its reply, the next line. A client beyond the limit is heard, too, because it may want to stop
/// the robot; everything else that it asks for is refused.
class Session : public std::enable_shared_from_this<Session> {
 public:
  Session(Protocol::socket socket, const Server::Options& options, bool is_one_too_many,
          std::function<void(Session*)> on_end)
      : socket_{std::move(socket)},
        patience_{socket_.get_executor()},
        options_{options},
        is_one_too_many_{is_one_too_many},
        on_end_{std::move(on_end)} {}

  void listen() {
    asio::async_read_until(
        socket_, asio::dynamic_buffer(received_, kLongestLine), '\n',
        [self = shared_from_this()](const error_code& error, std::size_t size) { self->take(error, size); });
  }

  void say_and_end(const std::string& line) {
    ends_ = true;
    say(line);
  }

  /// The instant since which the client has been silent; nullopt while a request of it is being answered.
  [[nodiscard]] std::optional<std::chrono::steady_clock::time_point> idle_since() const {
    return awaits_ || ends_ ? std::nullopt : std::optional{spoke_};
  }

  void close() {
    error_code ignored;
    patience_.cancel();
    socket_.close(ignored);
  }

 private:
  void take(const error_code& error, std::size_t size) {
    if (error == asio::error::not_found) {
      return say_and_end(error_line("a request has at most " + std::to_string(kLongestLine) + " bytes"));
    }
    if (error) return on_end_(this);
    spoke_ = std::chrono::steady_clock::now();
    const std::string line = received_.substr(0, size - 1);
    received_.erase(0, size);
    if (is_one_too_many_ && !is_stop(line)) return say_and_end(error_line("too many clients"));
    wait_for_reply();
    options_.handle(line, sockets::is_gone(socket_),
                    [self = weak_from_this(), number = number_, to = socket_.get_executor()](std::string reply) {
                      asio::post(to, [self, number, reply = std::move(reply)] {
                        if (const auto session = self.lock()) session->answer(number, reply);
                      });
                    });
  }

  void wait_for_reply() {
    ++number_;
    awaits_ = true;
    patience_.expires_after(std::chrono::duration_cast<std::chrono::steady_clock::duration>(
        std::chrono::duration<double>(options_.patience_s)));
    patience_.async_wait([self = shared_from_this(), number = number_](const error_code& error) {
      if (!error) self->answer(number, self->options_.late_reply);
    });
  }

  void answer(std::uint64_t number, const std::string& line) {
    if (!awaits_ || number != number_ || !socket_.is_open()) return;
    awaits_ = false;
    patience_.cancel();
    say(line);
  }

  void say(const std::string& line) {
    reply_ = line + "\n";
    asio::async_write(socket_, asio::buffer(reply_), [self = shared_from_this()](const error_code& error, std::size_t) {
      if (error || self->ends_) return self->on_end_(self.get());
      self->listen();
    });
  }

  Protocol::socket socket_;
  asio::steady_timer patience_;
  const Server::Options& options_;
  bool is_one_too_many_;
  std::function<void(Session*)> on_end_;
  std::string received_;
  std::string reply_;
  std::chrono::steady_clock::time_point spoke_ = std::chrono::steady_clock::now();
  std::uint64_t number_ = 0;  // of the request that is being answered
  bool awaits_ = false;
  bool ends_ = false;
};

}  // namespace

struct Server::State {
  explicit State(Options given)
      : options{std::move(given)},
        clients{sockets::listening_at(loop, options.socket),
                [this](Protocol::socket socket) { welcome(std::move(socket)); }, [this] { return make_room(); }} {}

  /// Closes the client that has been silent longest: silent clients must not keep out an order to stop.
  bool make_room() {
    Session* longest = nullptr;
    for (const auto& session : sessions) {
      if (!session->idle_since()) continue;
      if (longest == nullptr || *session->idle_since() < *longest->idle_since()) longest = session.get();
    }
    if (longest != nullptr) end(longest);
    return longest != nullptr;
  }

  void welcome(Protocol::socket socket) {
    if (sessions.size() >= most) (void)make_room();
    const bool is_full = sessions.size() >= most;
    const auto session =
        std::make_shared<Session>(std::move(socket), options, is_full, [this](Session* ended) { end(ended); });
    sessions.insert(session);
    session->listen();
  }

  void end(Session* ended) {
    clients.end([ended] { ended->close(); });
    std::erase_if(sessions, [ended](const auto& session) { return session.get() == ended; });
  }

  void close() {
    file.remove();
    clients.close();
    for (const auto& session : sessions) session->close();
    sessions.clear();
    loop.stop();
  }

  asio::io_context loop{1};
  Options options;
  std::size_t most = std::min(kMostClients, descriptors_beside(kOthersDescriptors, kFewestClients));
  sockets::AcceptLoop<Protocol> clients;
  sockets::SocketFile file{options.socket};
  std::set<std::shared_ptr<Session>> sessions;
};

Server::Server(Options options) : state_{std::make_unique<State>(std::move(options))} {}

Server::~Server() = default;

void Server::run() {
  const auto keep_alive = asio::make_work_guard(state_->loop);
  state_->clients.start();
  state_->loop.run();
}

void Server::stop() {
  asio::post(state_->loop, [this] { state_->close(); });
}

void Server::post(std::function<void()> work) { asio::post(state_->loop, std::move(work)); }

}  // namespace deltamap::daemon::control
