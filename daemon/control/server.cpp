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
#include <deque>
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
constexpr std::size_t kNewcomers = 16;          // who has just come does not leave for the next one
constexpr std::size_t kOthersDescriptors = 64;  // files, ports and the first connections of the page

/// One client: lines, and a reply to each in their order. While one is answered it is read on: an order to stop does
/// not wait for what was asked before it. One too many is heard, too: it may be somebody who wants to stop the robot,
/// and is refused whatever else it asks for.
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
    if (is_reading_ || is_over_ || waiting_bytes_ >= kMostWaitingBytes) return;
    is_reading_ = true;
    asio::async_read_until(
        socket_, asio::dynamic_buffer(received_, kLongestLine), '\n',
        [self = shared_from_this()](const error_code& error, std::size_t size) { self->take(error, size); });
  }

  /// The instant since which the client has been silent; nullopt while a request of it is being answered.
  [[nodiscard]] std::optional<std::chrono::steady_clock::time_point> idle_since() const {
    const bool awaits = !lines_.empty() && !lines_.front().reply;
    return awaits ? std::nullopt : std::optional{spoke_};
  }

  void close() {
    error_code ignored;
    patience_.cancel();
    socket_.close(ignored);
  }

 private:
  struct Line {
    std::string text{};
    std::uint64_t number = 0;
    bool is_begun = false;
    std::optional<std::string> reply{};
  };

  void take(const error_code& error, std::size_t size) {
    is_reading_ = false;
    if (!socket_.is_open()) return on_end_(this);
    if (error == asio::error::not_found) {
      refuse_and_end("a request has at most " + std::to_string(kLongestLine) + " bytes");
    } else if (error) {
      is_over_ = true;
    } else {
      spoke_ = std::chrono::steady_clock::now();
      add(received_.substr(0, size - 1));
      received_.erase(0, size);
    }
    listen();
    go_on();
  }

  void add(std::string text) {
    const bool stops = is_stop(text);
    if (is_one_too_many_ && !stops) return refuse_and_end("too many clients");
    waiting_bytes_ += text.size() + 1;
    lines_.push_back({.text = std::move(text), .number = next_number_++});
    if (stops) begin(lines_.back());
  }

  /// Behind the replies to what was asked before.
  void refuse_and_end(const std::string& why) {
    lines_.push_back({.number = next_number_++, .is_begun = true, .reply = error_line(why)});
    is_over_ = true;
  }

  void begin(Line& line) {
    line.is_begun = true;
    options_.handle(line.text, sockets::is_gone(socket_),
                    [self = weak_from_this(), number = line.number, to = socket_.get_executor()](std::string reply) {
                      asio::post(to, [self, number, reply = std::move(reply)] {
                        if (const auto session = self.lock()) session->answer(number, reply);
                      });
                    });
  }

  /// What is to be done for the first line.
  void go_on() {
    if (is_writing_) return;
    if (lines_.empty()) return is_over_ ? on_end_(this) : void();
    Line& first = lines_.front();
    if (!first.is_begun) begin(first);
    if (first.reply) return say(*first.reply);
    if (patient_with_ == first.number) return;
    patient_with_ = first.number;
    patience_.expires_after(std::chrono::duration_cast<std::chrono::steady_clock::duration>(
        std::chrono::duration<double>(options_.patience_s)));
    patience_.async_wait([self = shared_from_this(), number = first.number](const error_code& cancelled) {
      if (!cancelled) self->answer(number, self->options_.late_reply);
    });
  }

  void answer(std::uint64_t number, const std::string& reply) {
    const auto line = std::find_if(lines_.begin(), lines_.end(), [&](const Line& one) { return one.number == number; });
    if (line == lines_.end() || line->reply || !socket_.is_open()) return;
    line->reply = reply;
    go_on();
  }

  void say(const std::string& line) {
    patience_.cancel();
    is_writing_ = true;
    reply_ = line + "\n";
    asio::async_write(socket_, asio::buffer(reply_), [self = shared_from_this()](const error_code& error, std::size_t) {
      self->is_writing_ = false;
      if (error || !self->socket_.is_open()) return self->on_end_(self.get());
      self->waiting_bytes_ -= std::min(self->waiting_bytes_, self->lines_.front().text.size() + 1);
      self->lines_.pop_front();
      self->listen();
      self->go_on();
    });
  }

  static constexpr std::size_t kMostWaitingBytes = 16 * kLongestLine;

  Protocol::socket socket_;
  asio::steady_timer patience_;
  const Server::Options& options_;
  bool is_one_too_many_;
  std::function<void(Session*)> on_end_;
  std::string received_;
  std::deque<Line> lines_;  // that wait for their reply, or for its way to the client
  std::size_t waiting_bytes_ = 0;
  std::string reply_;
  std::chrono::steady_clock::time_point spoke_ = std::chrono::steady_clock::now();
  std::uint64_t next_number_ = 1;
  std::uint64_t patient_with_ = 0;  // the line whose reply is waited for
  bool is_reading_ = false;
  bool is_writing_ = false;
  bool is_over_ = false;  // nothing more is heard; ends behind the last reply
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

  [[nodiscard]] std::size_t idle() const {
    return static_cast<std::size_t>(std::count_if(
        sessions.begin(), sessions.end(), [](const auto& session) { return session->idle_since().has_value(); }));
  }

  void welcome(Protocol::socket socket) {
    if (sessions.size() >= most && idle() >= kNewcomers) (void)make_room();
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
  std::size_t most = std::min(kMostClients, descriptors_beside(kOthersDescriptors + kNewcomers, kFewestClients));
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
