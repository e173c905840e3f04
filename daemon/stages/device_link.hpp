// SPDX-License-Identifier: Apache-2.0
// Keeps one device's session on its port, in the io thread: opens the port, feeds the session bytes and time, does what
// it asks, and tries again after a pause when either fails. A device that is missing, busy or forbidden is named once.
#pragma once

#include <utility>  // Boost 1.74's awaitable.hpp needs it and does not say so

#include <boost/asio/io_context.hpp>
#include <boost/asio/steady_timer.hpp>
#include <functional>
#include <memory>
#include <string>

#include "daemon/records/recording_decoder.hpp"
#include "drivers/port/byte_port.hpp"
#include "drivers/port/port_clock.hpp"
#include "drivers/port/reconnect.hpp"
#include "drivers/port/recording_port.hpp"
#include "drivers/port/serial_port.hpp"
#include "drivers/session.hpp"

namespace deltamap::daemon {

/// Opens the device's port at a baud; the answer names why it cannot.
using PortOpener =
    std::function<drivers::port::SerialPortAnswer(boost::asio::io_context& loop, drivers::port::PortId, unsigned baud)>;

/// `Session` has start(), on_bytes(), on_time(), close() that answer an `Output` with a SessionOutput in `output`.
template <typename Session, typename Output>
class DeviceLink {
 public:
  struct Hooks {
    PortOpener open;
    drivers::port::RecordSink record;                     ///< every chunk and note
    std::function<void(Output&)> on_messages;             ///< what the session decoded
    std::function<void(const std::string& why)> on_lost;  ///< the port has failed or could not be opened
    // A short line each.
    std::function<void(const std::string&)> log;
    std::function<void(const std::string&)> warn;  ///< the device is gone, cannot be had, or needs its owner
    std::function<void(const std::string& port)> on_answered{};  ///< the device works behind this port; may be empty
  };

  DeviceLink(boost::asio::io_context& loop, drivers::port::PortId id, Session session, Hooks hooks)
      : loop_{loop},
        id_{id},
        session_{std::move(session)},
        hooks_{std::move(hooks)},
        wake_timer_{loop},
        retry_timer_{loop} {}

  void open() {
    auto answer = hooks_.open(loop_, id_, session_.baud());
    if (!answer.port) return retry(answer.refused);
    if (std::exchange(noted_, answer.note) != answer.note && !answer.note.empty()) log(answer.note);
    is_heard_ = true;
    reconnect_.opened();
    port_ = std::make_unique<drivers::port::RecordingPort>(
        std::move(answer.port), id_, [this](drivers::port::ByteRecord&& record) { keep(std::move(record)); },
        drivers::port::port_clock_now);
    port_->start({[this](std::span<const std::uint8_t> bytes, Timestamp stamp) { take(bytes, stamp); },
                  [this](const std::string& reason) {
                    // A port that is being let go may hang up as well: its session has failed before.
                    if (port_) fail(port_->name() + ": " + reason);
                  }});
    drivers::port::ByteRecord began;
    began.port = id_;
    began.stamp = drivers::port::port_clock_now();
    began.note = session_note(id_);
    const Timestamp now = began.stamp;
    hooks_.record(std::move(began));
    session_.on_baud(port_->baud());
    handle(session_.start(now));
  }

  /// What another part of the io thread made the session answer; during the farewell it is a part of that.
  void handle(Output out) {
    if (closed_) return say_farewell(out);
    // What stops a robot waits for nothing that its owner does about it.
    for (const drivers::PortRequest& request : out.output.requests) perform(request);
    hooks_.on_messages(out);
    for (const std::string& line : out.output.warnings) hooks_.warn(named(line));
    for (const std::string& line : out.output.log) log(line);
    if (out.output.failed) return fail(*out.output.failed);
    wake_at(out.output.wake_at);
  }

  /// The device works: told by its owner, which knows what that means.
  void tell_connected() {
    if (hooks_.on_answered && port_) hooks_.on_answered(port_->name());
    if (const auto line = reconnect_.connected()) log(*line);
  }

  /// Says farewell to the device, at the pace that it can take; nothing is read or tried again after it.
  void close() {
    closed_ = true;
    is_heard_ = false;
    retry_timer_.cancel();
    wake_timer_.cancel();
    if (port_) say_farewell(session_.close(drivers::port::port_clock_now()));
  }

  [[nodiscard]] Session& session() { return session_; }
  [[nodiscard]] const Session& session() const { return session_; }
  [[nodiscard]] bool is_open() const { return port_ != nullptr; }

 private:
  // What the session does not hear is not recorded either, so that a replay decodes the same.
  void keep(drivers::port::ByteRecord&& record) {
    const bool came_in = !record.bytes.empty() && record.direction == drivers::port::Direction::kIn;
    if (is_heard_ || !came_in) hooks_.record(std::move(record));
  }

  void say_farewell(const Output& out) {
    for (const drivers::PortRequest& request : out.output.requests) perform(request);
    for (const std::string& line : out.output.log) log(line);
    if (!out.output.wake_at || out.output.failed) return;
    call_at(*out.output.wake_at, [this] {
      if (port_) say_farewell(session_.on_time(drivers::port::port_clock_now()));
    });
  }

  void take(std::span<const std::uint8_t> bytes, Timestamp stamp) {
    if (!is_heard_) return;
    handle(session_.on_bytes(bytes, stamp));
    if (port_) port_->await(session_.awaited_bytes());
  }

  void perform(const drivers::PortRequest& request) {
    using Kind = drivers::PortRequest::Kind;
    if (!port_) return;
    if (request.kind == Kind::kWrite) port_->write(request.bytes);
    if (request.kind == Kind::kSetBaud) port_->set_baud(request.baud);
    if (request.kind == Kind::kDiscardInput) port_->discard_input();
  }

  void wake_at(const std::optional<Timestamp>& time) {
    wake_timer_.cancel();
    if (!time || closed_) return;
    call_at(*time, [this] {
      if (!closed_ && port_) handle(session_.on_time(drivers::port::port_clock_now()));
    });
  }

  template <typename Call>
  void call_at(Timestamp time, Call call) {
    wake_timer_.expires_after(std::max(Duration{0}, time - drivers::port::port_clock_now()));
    wake_timer_.async_wait([call](const boost::system::error_code& error) {
      if (!error) call();
    });
  }

  void fail(const std::string& reason) {
    wake_timer_.cancel();
    is_heard_ = false;
    // The port may be the caller: it is let go when its handlers have returned.
    leaving_ = std::move(port_);
    retry(reason);
  }

  void retry(const std::string& reason) {
    if (closed_) return;
    hooks_.on_lost(reason);
    const auto pause = reconnect_.failed(reason, drivers::port::port_clock_now());
    if (pause.log) hooks_.warn(named(*pause.log));
    retry_timer_.expires_after(std::max(Duration{0}, pause.try_again_at - drivers::port::port_clock_now()));
    retry_timer_.async_wait([this](const boost::system::error_code& error) {
      if (error || closed_) return;
      leaving_.reset();
      open();
    });
  }

  void log(const std::string& line) { hooks_.log(named(line)); }

  // Sessions name their device at the beginning of most lines.
  [[nodiscard]] std::string named(const std::string& line) const {
    const std::string name{name_of(id_)};
    return line.starts_with(name + " ") ? line : name + ": " + line;
  }

  boost::asio::io_context& loop_;
  drivers::port::PortId id_;
  Session session_;
  Hooks hooks_;
  boost::asio::steady_timer wake_timer_;
  boost::asio::steady_timer retry_timer_;
  drivers::port::Reconnect reconnect_{drivers::port::ReconnectParams{}};
  std::unique_ptr<drivers::port::RecordingPort> port_;
  std::unique_ptr<drivers::port::RecordingPort> leaving_;
  std::string noted_;  // of the port that was opened last
  bool is_heard_ = false;
  bool closed_ = false;
};

}  // namespace deltamap::daemon
