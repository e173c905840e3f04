// SPDX-License-Identifier: Apache-2.0
#include "daemon/sockets/line_stream.hpp"

#include <sys/eventfd.h>
#include <unistd.h>

#include <utility>  // Boost 1.74's awaitable.hpp needs it and does not say so

#include <array>
#include <atomic>
#include <boost/asio/buffer.hpp>
#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/local/stream_protocol.hpp>
#include <boost/asio/posix/stream_descriptor.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/read.hpp>
#include <boost/asio/write.hpp>
#include <cstdint>
#include <deque>
#include <set>
#include <stdexcept>
#include <vector>

#include "daemon/sockets/accept_loop.hpp"
#include "daemon/sockets/listening_socket.hpp"

namespace deltamap::daemon::sockets {
namespace {

namespace asio = boost::asio;
using Protocol = asio::local::stream_protocol;
using boost::system::error_code;
using Line = std::shared_ptr<const std::string>;  // with its line end

Line line_of(const std::string& text) { return std::make_shared<const std::string>(text + "\n"); }

int new_event() {
  const int event = ::eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC);
  if (event < 0) throw std::runtime_error("no event descriptor for the stream of poses");
  return event;
}

class Client : public std::enable_shared_from_this<Client> {
 public:
  Client(Protocol::socket socket, const LineStream::Options& options, std::function<void(Client*)> on_end)
      : socket_{std::move(socket)}, most_lines_{options.most_lines}, on_end_{std::move(on_end)} {
    error_code ignored;
    socket_.set_option(asio::socket_base::send_buffer_size(options.send_buffer_bytes), ignored);
  }

  /// Queues a line for this client; false where too many lines wait already.
  [[nodiscard]] bool send(const Line& line) {
    if (waiting_.size() >= most_lines_) return false;
    waiting_.push_back(line);
    if (waiting_.size() == 1) write();
    return true;
  }
  void send_last(const Line& line) {
    ends_ = true;
    (void)send(line);
  }

  /// Waits for the client's end: clients of a stream send nothing, and bytes from one end it as well.
  void listen() {
    socket_.async_read_some(asio::buffer(heard_), [self = shared_from_this()](const error_code& error, std::size_t) {
      const bool still_listens = error == asio::error::eof && !self->has_left();
      if (!still_listens) self->on_end_(self.get());
    });
  }

  [[nodiscard]] bool has_left() { return is_gone(socket_); }

  void close() {
    error_code ignored;
    socket_.close(ignored);
  }

 private:
  void write() {
    asio::async_write(socket_, asio::buffer(*waiting_.front()),
                      [self = shared_from_this()](const error_code& error, std::size_t) {
                        self->waiting_.pop_front();
                        if (error || (self->ends_ && self->waiting_.empty())) return self->on_end_(self.get());
                        if (!self->waiting_.empty()) self->write();
                      });
  }

  Protocol::socket socket_;
  std::size_t most_lines_;
  std::function<void(Client*)> on_end_;
  std::deque<Line> waiting_;  // the first one is on its way
  std::array<char, 64> heard_{};
  bool ends_ = false;
};

}  // namespace

struct LineStream::State {
  explicit State(Options given)
      : options{std::move(given)},
        arrivals{listening_at(loop, options.socket), [this](Protocol::socket socket) { welcome(std::move(socket)); }},
        event{loop, new_event()} {}

  void welcome(Protocol::socket socket) {
    end_if([](Client& client) { return client.has_left(); });
    const auto client = std::make_shared<Client>(
        std::move(socket), options, [this](Client* ended) { end_if([ended](Client& one) { return &one == ended; }); });
    const bool is_full = clients.size() >= options.most_clients;
    clients.insert(client);
    count = clients.size();
    if (is_full) return client->send_last(line_of(options.refusal));
    (void)client->send(line_of(options.greeting));
    client->listen();
  }

  template <typename Which>
  void end_if(const Which& which) {
    for (auto client = clients.begin(); client != clients.end();) {
      if (which(**client)) {
        (*client)->close();
        client = clients.erase(client);
      } else {
        ++client;
      }
    }
    count = clients.size();
  }

  void wait_for_lines() {
    asio::async_read(event, asio::buffer(&woken, sizeof woken), [this](const error_code& error, std::size_t) {
      if (error) return;
      while (const auto text = options.next()) {
        const Line line = line_of(*text);
        end_if([&line](Client& client) { return !client.send(line); });
      }
      wait_for_lines();
    });
  }

  void close() {
    file.remove();
    arrivals.close();
    end_if([](Client&) { return true; });
    loop.stop();
  }

  asio::io_context loop{1};
  Options options;
  AcceptLoop<Protocol> arrivals;
  SocketFile file{options.socket};
  asio::posix::stream_descriptor event;
  std::uint64_t woken = 0;
  std::set<std::shared_ptr<Client>> clients;
  std::atomic<std::size_t> count{0};  // of clients, for other threads
};

LineStream::LineStream(Options options) : state_{std::make_unique<State>(std::move(options))} {}

LineStream::~LineStream() = default;

bool LineStream::has_clients() const { return state_->count.load(std::memory_order_relaxed) > 0; }

void LineStream::wake() {
  constexpr std::uint64_t kOnce = 1;
  (void)!::write(state_->event.native_handle(), &kOnce, sizeof kOnce);  // full: it is awake already
}

void LineStream::run() {
  const auto keep_alive = asio::make_work_guard(state_->loop);
  state_->arrivals.start();
  state_->wait_for_lines();
  state_->loop.run();
}

void LineStream::stop() {
  asio::post(state_->loop, [this] { state_->close(); });
}

void LineStream::post(std::function<void()> work) { asio::post(state_->loop, std::move(work)); }

}  // namespace deltamap::daemon::sockets
