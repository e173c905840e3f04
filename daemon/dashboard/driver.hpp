// SPDX-License-Identifier: Apache-2.0
// One who drives at /drive: the only WebSocket that takes messages. Included by server.cpp alone.
#pragma once

#include <boost/asio/buffer.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core/buffers_to_string.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/websocket/stream.hpp>

#include "daemon/dashboard/connection.hpp"

namespace deltamap::daemon::dashboard {

inline constexpr std::size_t kMostSpokenBytes = 256;
inline constexpr std::chrono::seconds kDriverSilence{5};

/// Both sides speak; at most one message is on its way to the client. Whatever ends the connection ends the dialog.
class Driver final : public Connection, public std::enable_shared_from_this<Driver> {
 public:
  Driver(beast::tcp_stream stream, Guest who, Host& host, std::function<void(Driver*)> on_end)
      : Connection{std::move(who)},
        socket_{std::move(stream)},
        host_{host},
        on_end_{std::move(on_end)},
        period_timer_{socket_.get_executor()} {
    socket_.set_option(websocket::stream_base::timeout{kHttpPatience, kDriverSilence, true});
    socket_.read_message_max(kMostSpokenBytes);
    socket_.auto_fragment(false);
  }

  void welcome(const HttpRequest& request) {
    socket_.async_accept(request, [self = shared_from_this()](const error_code& error) {
      if (error) return self->on_end_(self.get());
      self->dialog_ = self->host_.options.converse();
      self->listen();
      self->serve();
      self->wait_for_period();
    });
  }
  void close() override {
    error_code ignored;
    dialog_.reset();
    period_timer_.cancel();
    beast::get_lowest_layer(socket_).socket().close(ignored);
  }
  void leave() override { on_end_(this); }

 private:
  void listen() {
    socket_.async_read(buffer_, [self = shared_from_this()](const error_code& error, std::size_t) {
      if (error || !self->dialog_) return self->on_end_(self.get());
      self->dialog_->hear(beast::buffers_to_string(self->buffer_.data()));
      self->buffer_.clear();
      self->serve();
      self->listen();
    });
  }

  void serve() {
    if (!dialog_ || is_sending_ || is_closing_) return;
    auto message = dialog_->next();
    if (!message) return dialog_->is_over() ? say_goodbye() : void();
    is_sending_ = true;
    on_the_way_ = std::move(message->bytes);
    socket_.binary(message->is_binary);
    socket_.async_write(asio::buffer(*on_the_way_), [self = shared_from_this()](const error_code& error, std::size_t) {
      self->is_sending_ = false;
      if (error) return self->on_end_(self.get());
      self->serve();
    });
  }

  void say_goodbye() {
    is_closing_ = true;
    dialog_.reset();
    socket_.async_close(websocket::close_code::normal,
                        [self = shared_from_this()](const error_code&) { self->on_end_(self.get()); });
  }

  void wait_for_period() {
    period_timer_.expires_after(duration_of(host_.options.period_s));
    period_timer_.async_wait([self = shared_from_this()](const error_code& error) {
      if (error || !self->dialog_) return;
      self->serve();
      self->wait_for_period();
    });
  }

  websocket::stream<beast::tcp_stream> socket_;
  Host& host_;
  std::function<void(Driver*)> on_end_;
  asio::steady_timer period_timer_;
  beast::flat_buffer buffer_{kMostSpokenBytes};
  std::unique_ptr<Dialog> dialog_;  // null until the handshake is done, and from the end on
  std::shared_ptr<const std::string> on_the_way_;
  bool is_sending_ = false;
  bool is_closing_ = false;
};

}  // namespace deltamap::daemon::dashboard
