// SPDX-License-Identifier: Apache-2.0
// One viewer at /live. Included by server.cpp alone.
#pragma once

#include <boost/asio/buffer.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/websocket/stream.hpp>

#include "daemon/dashboard/connection.hpp"

namespace deltamap::daemon::dashboard {

inline constexpr std::size_t kMostIncomingBytes = 1024;    // a viewer has nothing to say
inline constexpr std::chrono::seconds kViewerSilence{30};  // then a ping, which it must answer

/// At most one message is on its way; what comes after it is asked for when it has gone.
class Viewer final : public Connection, public std::enable_shared_from_this<Viewer> {
 public:
  Viewer(beast::tcp_stream stream, Guest who, Host& host, std::function<void(Viewer*)> on_end)
      : Connection{std::move(who)}, socket_{std::move(stream)}, host_{host}, on_end_{std::move(on_end)} {
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
  void leave() override { on_end_(this); }

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

}  // namespace deltamap::daemon::dashboard
