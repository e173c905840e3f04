// SPDX-License-Identifier: Apache-2.0
// One client over HTTP: a request, its answer, the next request. Included by server.cpp alone.
#pragma once

#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/read.hpp>
#include <boost/beast/http/write.hpp>
#include <boost/beast/websocket/rfc6455.hpp>

#include "daemon/dashboard/access.hpp"
#include "daemon/dashboard/connection.hpp"

namespace deltamap::daemon::dashboard {

inline constexpr std::uint32_t kMostHeaderBytes = 8192;
inline constexpr std::uint64_t kMostBodyBytes = 4096;  // as a line of the control socket

// Nothing of another site runs or is shown here, and nothing of this page there.
inline constexpr std::pair<const char*, const char*> kEveryAnswer[] = {
    {"Content-Security-Policy",
     "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data:; connect-src 'self'; base-uri "
     "'none'; form-action 'none'; frame-ancestors 'none'"},
    {"X-Content-Type-Options", "nosniff"},
    {"X-Frame-Options", "DENY"},
    {"Referrer-Policy", "no-referrer"},
    {"Cross-Origin-Resource-Policy", "same-origin"},
    {"Cross-Origin-Opener-Policy", "same-origin"},
    {"Cache-Control", "no-store"}};

inline std::string text_of(boost::string_view text) { return {text.data(), text.size()}; }

inline Request request_of(const HttpRequest& request) {
  const std::string target = text_of(request.target());
  const auto query = target.find('?');
  const auto field = [&request](http::field name) { return text_of(request[name]); };
  return {.method = text_of(request.method_string()),
          .path = target.substr(0, query),
          .query = query == std::string::npos ? "" : target.substr(query + 1),
          .host = field(http::field::host),
          .origin = field(http::field::origin),
          .cookie = field(http::field::cookie),
          .authorization = field(http::field::authorization),
          .content_type = field(http::field::content_type)};
}

/// An address of IPv4 as such, also where IPv6 writes it. Unspecified where the client has gone.
inline asio::ip::address address_of(const tcp::socket& socket) {
  error_code error;
  const asio::ip::address address = socket.remote_endpoint(error).address();
  if (address.is_v4() || !address.to_v6().is_v4_mapped()) return address;
  return asio::ip::make_address_v4(asio::ip::v4_mapped, address.to_v6());
}

/// Whose places a client takes: of IPv6 a whole network belongs to one.
inline std::string owner_of(const asio::ip::address& address) {
  if (address.is_v4()) return address.to_string();
  auto bytes = address.to_v6().to_bytes();
  std::fill(bytes.begin() + bytes.size() / 2, bytes.end(), std::uint8_t{0});
  return asio::ip::address_v6{bytes}.to_string();
}

inline bool is_bad_http(const error_code& error) {
  return error.category() == make_error_code(http::error::bad_method).category() &&
         error != http::error::end_of_stream && error != http::error::partial_message;
}

class HttpConnection final : public Connection, public std::enable_shared_from_this<HttpConnection> {
 public:
  HttpConnection(tcp::socket socket, Guest who, Host& host)
      : Connection{std::move(who)}, stream_{std::move(socket)}, host_{host}, patience_{stream_.get_executor()} {}

  /// Has just come. The timer ends behind all that has been read by then: a loop that was busy does not shorten it.
  void welcome() {
    host_.let_stand(guest, Standing::kHasCome);
    patience_.expires_after(duration_of(host_.options.time_to_speak_s));
    patience_.async_wait([self = shared_from_this()](const error_code& cancelled) {
      if (!cancelled && self->guest.standing == Standing::kHasCome) {
        self->host_.let_stand(self->guest, Standing::kWaits);
      }
    });
    listen();
  }
  void close() override {
    error_code ignored;
    patience_.cancel();
    stream_.socket().close(ignored);
  }
  void leave() override { host_.end(this); }

 private:
  void listen() {
    parser_.emplace();
    parser_->header_limit(kMostHeaderBytes);
    parser_->body_limit(kMostBodyBytes);
    stream_.expires_after(kHttpPatience);
    http::async_read_header(stream_, buffer_, *parser_,
                            [self = shared_from_this()](const error_code& error, std::size_t) { self->take(error); });
  }

  void listen_again() {
    host_.let_stand(guest, Standing::kWaits);
    listen();
  }

  void take(const error_code& error) {
    if (tells_why_not_read(error)) return;
    if (error || host_.is_ending) return host_.end(this);
    const bool has_body = parser_->chunked() || parser_->content_length().value_or(0) > 0;
    const HttpRequest& received = parser_->get();
    Request request = request_of(received);
    request.is_from_loopback = address_of(stream_.socket()).is_loopback();
    const unsigned version = received.version();
    const Guard& guard = host_.options.guard;
    guest.is_known = is_known(request, guard);
    if (const auto entry = entry_of(request, guard.token)) return say(*entry, version, false);
    unless_stop_ = refusal_of(request, guard);
    if (unless_stop_ && !may_stop(request, guard)) return say(*unless_stop_, version, false);
    if (request.path == kCommandPath) return read_command(request, version);
    if (has_body) return say({.status = 413, .body = "a request has no body here\n"}, version, false);
    if (request.path == "/live" || request.path == kDrivePath) return take_viewer(request.path);
    host_.let_stand(guest, Standing::kIsAnswered);
    host_.turns.add([self = shared_from_this(), request, version, goes_on = received.keep_alive()] {
      if (self->stream_.socket().is_open()) self->say(self->answer_to(request), version, goes_on);
    });
  }

  bool tells_why_not_read(const error_code& error) {
    if (error == http::error::header_limit || error == http::error::buffer_overflow) {
      say({.status = 431, .body = "the header is too long\n"}, 11, false);
    } else if (error == http::error::body_limit) {
      say({.status = 413, .body = "the body is too long\n"}, 11, false);
    } else if (is_bad_http(error)) {
      say({.status = 400, .body = "that is no HTTP request\n"}, 11, false);
    } else {
      return false;
    }
    return true;
  }

  /// A request that cannot be answered, for want of memory say, fails alone.
  [[nodiscard]] Answer answer_to(const Request& request) const {
    try {
      return host_.options.answer(request);
    } catch (const std::exception& error) {
      return {.status = 500, .body = std::string(error.what()) + "\n"};
    }
  }

  void read_command(const Request& request, unsigned version) {
    if (parser_->chunked() || !parser_->content_length()) {
      return say({.status = 411, .body = "a command needs Content-Length\n"}, version, false);
    }
    stream_.expires_after(kHttpPatience);
    http::async_read(stream_, buffer_, *parser_,
                     [self = shared_from_this(), request](const error_code& error, std::size_t) {
                       self->take_command(error, request);
                     });
  }

  void take_command(const error_code& error, Request request) {
    if (tells_why_not_read(error)) return;
    if (error || host_.is_ending) return host_.end(this);
    request.body = parser_->get().body();
    const unsigned version = parser_->get().version();
    const bool goes_on = parser_->get().keep_alive();
    is_stop_ = host_.options.is_stop(request.body);
    if (unless_stop_ && !is_stop_) return say(*unless_stop_, version, false);
    if (!is_stop_ && host_.commands >= host_.most_commands()) return say(host_.options.busy_answer, version, false);
    host_.commands += is_stop_ ? 0 : 1;
    host_.let_stand(guest, Standing::kStays);
    patience_.expires_after(duration_of(host_.options.command_patience_s));
    patience_.async_wait([self = shared_from_this(), number = ++command_, version](const error_code& cancelled) {
      if (!cancelled) self->reply(number, self->host_.options.late_answer, version, false);
    });
    host_.options.command(request, [self = weak_from_this(), number = command_, version, goes_on,
                                    to = stream_.get_executor()](Answer answer) {
      asio::post(to, [self, number, version, goes_on, answer = std::move(answer)] {
        if (const auto connection = self.lock()) connection->reply(number, answer, version, goes_on);
      });
    });
  }

  void reply(std::uint64_t number, const Answer& answer, unsigned version, bool goes_on) {
    if (number != command_) return;
    ++command_;  // the first one counts
    host_.commands -= is_stop_ ? 0 : 1;
    patience_.cancel();
    if (stream_.socket().is_open()) say(answer, version, goes_on);
  }

  void take_viewer(const std::string& path) {
    patience_.cancel();
    const HttpRequest request = parser_->release();
    if (!websocket::is_upgrade(request)) {
      return say({.status = 426, .body = path + " is a WebSocket\n", .headers = {{"Upgrade", "websocket"}}}, 11, false);
    }
    const auto self = shared_from_this();  // outlives its place in the list
    stream_.expires_never();
    host_.upgrade(std::move(stream_), request, guest);
    std::erase_if(host_.connections, [this](const auto& connection) { return connection.get() == this; });
  }

  void say(Answer answer, unsigned version, bool goes_on) {
    response_ = {static_cast<http::status>(answer.status), version};
    for (const auto& [name, value] : kEveryAnswer) response_.set(name, value);
    for (const auto& [name, value] : answer.headers) response_.set(name, value);
    response_.set(http::field::content_type, answer.type);
    response_.body() = std::move(answer.body);
    response_.keep_alive(goes_on);
    response_.prepare_payload();
    const std::size_t size = response_.body().size();
    host_.turns.began(size);
    host_.let_stand(guest, Standing::kIsAnswered);
    stream_.expires_after(kHttpPatience);
    http::async_write(stream_, response_,
                      [self = shared_from_this(), goes_on, size](const error_code& error, std::size_t) {
                        self->response_ = {};
                        self->host_.turns.ended(size);
                        if (!error && goes_on) return self->listen_again();
                        self->host_.end(self.get());
                      });
  }

  beast::tcp_stream stream_;
  Host& host_;
  asio::steady_timer patience_;        // for the first words, then for what becomes of a command
  std::uint64_t command_ = 0;          // counts the commands that were taken, and their answers
  bool is_stop_ = false;               // the newest command
  std::optional<Answer> unless_stop_;  // what is said to a command that is none
  beast::flat_buffer buffer_{kMostHeaderBytes + kMostBodyBytes + 1024};
  std::optional<http::request_parser<http::string_body>> parser_;
  http::response<http::string_body> response_;
};

}  // namespace deltamap::daemon::dashboard
