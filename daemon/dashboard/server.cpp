// SPDX-License-Identifier: Apache-2.0
// The one source that includes Beast.
#include "daemon/dashboard/server.hpp"

#include <utility>  // Boost 1.74's awaitable.hpp needs it and does not say so

#include <atomic>
#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/read.hpp>
#include <boost/beast/http/string_body.hpp>
#include <boost/beast/http/write.hpp>
#include <boost/beast/websocket/rfc6455.hpp>
#include <boost/beast/websocket/stream.hpp>
#include <chrono>
#include <set>
#include <stdexcept>
#include <vector>

#include "daemon/accept_loop.hpp"
#include "daemon/dashboard/access.hpp"
#include "daemon/dashboard/listening_socket.hpp"

namespace deltamap::daemon::dashboard {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using boost::system::error_code;
using tcp = asio::ip::tcp;
using Clock = std::chrono::steady_clock;
using HttpRequest = http::request<http::empty_body>;

constexpr std::uint32_t kMostHeaderBytes = 8192;
constexpr std::size_t kMostIncomingBytes = 1024;  // a viewer has nothing to say
constexpr int kSendBuffer = 128 * 1024;           // of the kernel, for each connection
constexpr std::chrono::seconds kHttpPatience{10};
constexpr std::chrono::seconds kViewerSilence{30};  // then a ping, which it must answer

// Nothing of another site runs or is shown here, and nothing of this page there.
constexpr std::pair<const char*, const char*> kEveryAnswer[] = {
    {"Content-Security-Policy",
     "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data:; connect-src 'self'; base-uri "
     "'none'; form-action 'none'; frame-ancestors 'none'"},
    {"X-Content-Type-Options", "nosniff"},
    {"X-Frame-Options", "DENY"},
    {"Referrer-Policy", "no-referrer"},
    {"Cross-Origin-Resource-Policy", "same-origin"},
    {"Cross-Origin-Opener-Policy", "same-origin"},
    {"Cache-Control", "no-store"}};

Clock::duration duration_of(double time_s) {
  return std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(time_s));
}

std::string text_of(boost::string_view text) { return {text.data(), text.size()}; }

Request request_of(const HttpRequest& request) {
  const std::string target = text_of(request.target());
  const auto query = target.find('?');
  const auto field = [&request](http::field name) { return text_of(request[name]); };
  return {.method = text_of(request.method_string()),
          .path = target.substr(0, query),
          .query = query == std::string::npos ? "" : target.substr(query + 1),
          .host = field(http::field::host),
          .origin = field(http::field::origin),
          .cookie = field(http::field::cookie),
          .authorization = field(http::field::authorization)};
}

bool is_bad_http(const error_code& error) {
  return error.category() == make_error_code(http::error::bad_method).category() &&
         error != http::error::end_of_stream && error != http::error::partial_message;
}

/// A connection in the server's list; closing it ends whatever waits on it.
class Connection {
 public:
  Connection() = default;
  virtual ~Connection() = default;
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;
  virtual void close() = 0;
};

/// What connections may ask of the server's state.
struct Host {
  Server::Options options;
  std::atomic<bool> is_ending{false};  // what waits its turn is not answered any more
  std::set<std::shared_ptr<Connection>> connections{};
  std::function<void(beast::tcp_stream, const HttpRequest&)> upgrade{};

  void end(Connection* ended) {
    ended->close();
    std::erase_if(connections, [ended](const auto& connection) { return connection.get() == ended; });
  }
};

/// One client over HTTP: a request, its answer, the next request.
class HttpConnection final : public Connection, public std::enable_shared_from_this<HttpConnection> {
 public:
  HttpConnection(tcp::socket socket, Host& host) : stream_{std::move(socket)}, host_{host} {}

  void listen() {
    parser_.emplace();
    parser_->header_limit(kMostHeaderBytes);
    stream_.expires_after(kHttpPatience);
    http::async_read_header(stream_, buffer_, *parser_,
                            [self = shared_from_this()](const error_code& error, std::size_t) { self->take(error); });
  }
  void close() override {
    error_code ignored;
    stream_.socket().close(ignored);
  }

 private:
  void take(const error_code& error) {
    if (error == http::error::header_limit || error == http::error::buffer_overflow) {
      return say({.status = 431, .body = "the header is too long\n"}, 11, false);
    }
    if (is_bad_http(error)) {
      return say({.status = 400, .body = "that is no HTTP request\n"}, 11, false);
    }
    if (error || host_.is_ending) return host_.end(this);
    const bool has_body = parser_->chunked() || parser_->content_length().value_or(0) > 0;
    const HttpRequest& received = parser_->get();
    const Request request = request_of(received);
    const unsigned version = received.version();
    const std::string& token = host_.options.token;
    if (const auto entry = entry_of(request, token)) return say(*entry, version, false);
    if (auto refusal = refusal_of(request, token)) return say(*refusal, version, false);
    if (has_body) return say({.status = 413, .body = "a request has no body here\n"}, version, false);
    if (request.path == "/live") return take_viewer();
    say(answer_to(request), version, received.keep_alive());
  }

  /// A request that cannot be answered, for want of memory say, fails alone.
  [[nodiscard]] Answer answer_to(const Request& request) const {
    try {
      return host_.options.answer(request);
    } catch (const std::exception& error) {
      return {.status = 500, .body = std::string(error.what()) + "\n"};
    }
  }

  void take_viewer() {
    const HttpRequest request = parser_->release();
    if (!websocket::is_upgrade(request)) {
      return say({.status = 426, .body = "/live is a WebSocket\n", .headers = {{"Upgrade", "websocket"}}}, 11, false);
    }
    const auto self = shared_from_this();  // outlives its place in the list
    stream_.expires_never();
    host_.upgrade(std::move(stream_), request);
    std::erase_if(host_.connections, [this](const auto& connection) { return connection.get() == this; });
  }

  void say(const Answer& answer, unsigned version, bool goes_on) {
    response_ = {static_cast<http::status>(answer.status), version};
    for (const auto& [name, value] : kEveryAnswer) response_.set(name, value);
    for (const auto& [name, value] : answer.headers) response_.set(name, value);
    response_.set(http::field::content_type, answer.type);
    response_.body() = answer.body;
    response_.keep_alive(goes_on);
    response_.prepare_payload();
    stream_.expires_after(kHttpPatience);
    http::async_write(stream_, response_, [self = shared_from_this(), goes_on](const error_code& error, std::size_t) {
      if (!error && goes_on) return self->listen();
      self->host_.end(self.get());
    });
  }

  beast::tcp_stream stream_;
  Host& host_;
  beast::flat_buffer buffer_{kMostHeaderBytes + 1024};
  std::optional<http::request_parser<http::empty_body>> parser_;
  http::response<http::string_body> response_;
};

/// One viewer at /live. At most one message is on its way; what comes after it is asked for when it has gone.
class Viewer final : public Connection, public std::enable_shared_from_this<Viewer> {
 public:
  Viewer(beast::tcp_stream stream, Host& host, std::function<void(Viewer*)> on_end)
      : socket_{std::move(stream)}, host_{host}, on_end_{std::move(on_end)} {
    socket_.set_option(websocket::stream_base::timeout{kHttpPatience, kViewerSilence, true});
    socket_.read_message_max(kMostIncomingBytes);
    socket_.auto_fragment(false);
  }

  void welcome(const HttpRequest& request) {
    socket_.async_accept(request, [self = shared_from_this()](const error_code& error) {
      if (error) return self->on_end_(self.get());
      self->stream_ = self->host_.options.open();
      self->listen();
      self->serve();
    });
  }
  /// Sends what there is, unless a message is still on its way.
  void serve() {
    if (!stream_ || is_sending_) return;
    auto message = stream_->next();
    if (!message) return;
    is_sending_ = true;
    sending_since_ = Clock::now();
    on_the_way_ = std::move(message->bytes);
    socket_.binary(message->is_binary);
    socket_.async_write(asio::buffer(*on_the_way_), [self = shared_from_this()](const error_code& error, std::size_t) {
      self->is_sending_ = false;
      if (error) return self->on_end_(self.get());
      self->serve();
    });
  }
  [[nodiscard]] bool is_stuck(Clock::time_point now) const {
    return is_sending_ && now - sending_since_ > duration_of(host_.options.patience_s);
  }
  void close() override {
    error_code ignored;
    beast::get_lowest_layer(socket_).socket().close(ignored);
  }

 private:
  /// Reads only to answer pings and to notice closing and errors. The page is read-only: a viewer that sends data is
  /// closed.
  void listen() {
    socket_.async_read(buffer_, [self = shared_from_this()](const error_code& error, std::size_t) {
      if (error) return self->on_end_(self.get());
      self->socket_.async_close(websocket::close_code::policy_error,
                                [self](const error_code&) { self->on_end_(self.get()); });
    });
  }

  websocket::stream<beast::tcp_stream> socket_;
  Host& host_;
  std::function<void(Viewer*)> on_end_;
  beast::flat_buffer buffer_{kMostIncomingBytes};
  std::unique_ptr<Stream> stream_;  // null until the handshake is done
  std::shared_ptr<const std::string> on_the_way_;
  bool is_sending_ = false;
  Clock::time_point sending_since_;
};

}  // namespace

struct Server::State {
  explicit State(Options given)
      : host{.options = std::move(given)},
        clients{listening_socket(loop, host.options), [this](tcp::socket socket) { welcome(std::move(socket)); }},
        period_timer{loop} {
    host.upgrade = [this](beast::tcp_stream stream, const HttpRequest& request) {
      welcome_viewer(std::move(stream), request);
    };
  }
  ~State() { close(); }

  /// One too many is not answered: that would keep it.
  void welcome(tcp::socket socket) {
    if (host.connections.size() >= host.options.most_connections) return;
    error_code ignored;
    socket.set_option(tcp::no_delay(true), ignored);
    socket.set_option(asio::socket_base::send_buffer_size(kSendBuffer), ignored);
    const auto connection = std::make_shared<HttpConnection>(std::move(socket), host);
    host.connections.insert(connection);
    connection->listen();
  }

  void welcome_viewer(beast::tcp_stream stream, const HttpRequest& request) {
    if (viewers.size() >= host.options.most_viewers) return;
    const auto viewer = std::make_shared<Viewer>(std::move(stream), host, [this](Viewer* ended) { end_viewer(ended); });
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
    viewers.clear();
    loop.stop();
  }

  Host host;
  std::set<Viewer*> viewers;  // among the connections
  asio::io_context loop{1};
  AcceptLoop<tcp> clients;
  asio::steady_timer period_timer;
  Clock::time_point next_period;
};

Server::Server(Options options) : state_{std::make_unique<State>(std::move(options))} {}
Server::~Server() = default;

std::uint16_t Server::port() const { return state_->clients.place().port(); }

std::string Server::place() const { return place_of(state_->clients.place()); }

void Server::run() {
  const auto keep_alive = asio::make_work_guard(state_->loop);
  state_->clients.start();
  state_->loop.run();
}

void Server::stop() {
  state_->host.is_ending = true;
  asio::post(state_->loop, [this] { state_->close(); });
}

}  // namespace deltamap::daemon::dashboard
