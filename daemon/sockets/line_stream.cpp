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
#include <string>
#include <string_view>
#include <vector>

#include "daemon/sockets/accept_loop.hpp"
#include "daemon/sockets/listening_socket.hpp"

namespace deltamap::daemon::sockets {
namespace {

namespace asio = boost::asio;
using Protocol = asio::local::stream_protocol;
using boost::system::error_code;
constexpr std::size_t kMostSaid = 256;  // bytes of a client's line

/// With its line end.
using SharedLine = std::shared_ptr<const LineStream::Line>;

SharedLine line_of(LineStream::Line line) {
  line.text += "\n";
  return std::make_shared<const LineStream::Line>(std::move(line));
}

int new_event() {
  const int event = ::eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC);
  if (event < 0) throw std::runtime_error("no event descriptor for the stream of poses");
  return event;
}

class Client : public std::enable_shared_from_this<Client> {
 public:
  Client(Protocol::socket socket, const LineStream::Options& options, std::function<void(Client*)> on_end)
      : socket_{std::move(socket)}, options_{options}, on_end_{std::move(on_end)}, kinds_{options.first_kinds} {
    error_code ignored;
    socket_.set_option(asio::socket_base::send_buffer_size(options.send_buffer_bytes), ignored);
  }

  /// Queues a line for this client; false where too many lines wait already.
  [[nodiscard]] bool send(const SharedLine& line) {
    if (ends_) return true;
    std::size_t& waiting = line->is_soon_old ? soon_old_waiting_ : others_waiting_;
    if (waiting >= (line->is_soon_old ? options_.most_lines : options_.most_others)) return false;
    ++waiting;
    waiting_.push_back(line);
    if (waiting_.size() == 1) write();
    return true;
  }
  void send_last(const SharedLine& line) {
    (void)send(line);
    ends_ = true;
  }
  [[nodiscard]] bool wants(const LineStream::Line& line) const { return (kinds_ & line.kind) != 0; }

  /// Waits for what the client says, and for its end.
  void listen() {
    socket_.async_read_some(asio::buffer(heard_),
                            [self = shared_from_this()](const error_code& error, std::size_t count) {
                              const bool still_listens = error == asio::error::eof && !self->has_left();
                              if (still_listens) return;
                              if (error || !self->hear({self->heard_.data(), count})) return self->on_end_(self.get());
                              self->listen();
                            });
  }

  [[nodiscard]] bool has_left() { return is_gone(socket_); }

  void close() {
    error_code ignored;
    socket_.close(ignored);
  }

 private:
  /// False where it is too much, or nobody understands it.
  [[nodiscard]] bool hear(std::string_view bytes) {
    if (!options_.hear) return false;
    said_ += bytes;
    for (auto end = said_.find('\n'); end != std::string::npos && !ends_; end = said_.find('\n')) {
      const LineStream::Wish wish = options_.hear(said_.substr(0, end));
      said_.erase(0, end + 1);
      const SharedLine reply = line_of({.text = wish.reply});
      if (wish.kinds == 0 && !waiting_.empty()) return false;  // who does not read would keep its place for ever
      if (wish.kinds == 0) send_last(reply);
      if (wish.kinds != 0 && !send(reply)) return false;
      kinds_ = wish.kinds;
    }
    return said_.size() <= kMostSaid;
  }

  void write() {
    asio::async_write(socket_, asio::buffer(waiting_.front()->text),
                      [self = shared_from_this()](const error_code& error, std::size_t) {
                        --(self->waiting_.front()->is_soon_old ? self->soon_old_waiting_ : self->others_waiting_);
                        self->waiting_.pop_front();
                        if (error || (self->ends_ && self->waiting_.empty())) return self->on_end_(self.get());
                        if (!self->waiting_.empty()) self->write();
                      });
  }

  Protocol::socket socket_;
  const LineStream::Options& options_;
  std::function<void(Client*)> on_end_;
  unsigned kinds_;
  std::deque<SharedLine> waiting_;  // the first one is on its way
  std::size_t soon_old_waiting_ = 0;
  std::size_t others_waiting_ = 0;
  std::string said_;  // a line that is not whole yet
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
    if (is_full) return client->send_last(line_of({.text = options.refusal}));
    (void)client->send(line_of({.text = options.greeting}));
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
      while (auto next = options.next()) {
        const SharedLine line = line_of(*std::move(next));
        end_if([&](Client& client) {
          const bool is_slow = client.wants(*line) && !client.send(line);
          if (is_slow) options.dropped();
          return is_slow;
        });
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
