// SPDX-License-Identifier: Apache-2.0
// One session on one line in virtual time: what daemon/stages/device_link does with a serial port and the clock.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "core/time.hpp"
#include "daemon/records/recording_decoder.hpp"
#include "drivers/port/byte_record.hpp"
#include "drivers/port/reconnect.hpp"
#include "drivers/session.hpp"

namespace deltamap::experiments {

template <typename Session, typename Output>
class VirtualLink {
 public:
  struct Hooks {
    std::function<void(std::span<const std::uint8_t>, unsigned baud)> write;
    std::function<void(Output&)> on_messages;         ///< after all that the session answers
    std::function<void(std::string note)> on_note{};  ///< a session begins, the line changes its speed; may be empty
    std::function<void(std::string line)>
        on_lost{};  ///< what the operator reads where the session has failed; may be empty
  };
  VirtualLink(drivers::port::PortId id, Session session, Hooks hooks)
      : id_{id}, session_{std::move(session)}, hooks_{std::move(hooks)} {}

  /// The port is open.
  void start(Timestamp now) {
    try_again_at_.reset();
    if (hooks_.on_note) hooks_.on_note(daemon::session_note(id_));
    handle(session_.start(now), now);
  }

  void handle(Output out, Timestamp now) {
    if (!is_open()) return;  // no port to write to
    for (const drivers::PortRequest& request : out.output.requests) {
      if (request.kind == drivers::PortRequest::Kind::kWrite) hooks_.write(request.bytes, baud_);
      if (request.kind == drivers::PortRequest::Kind::kSetBaud) set_baud(request.baud);
    }
    wake_at_ = out.output.wake_at;
    if (out.output.failed) lose(*out.output.failed, now);
    hooks_.on_messages(out);
  }

  /// What has come by now. Without a port it hangs up, as an adapter that is pulled out, and cannot be opened.
  void turn(std::span<const std::uint8_t> bytes, bool has_port, Timestamp now) {
    if (is_open() && !has_port) return lose("the device hung up", now);
    if (try_again_at_) {
      if (now < *try_again_at_) return;
      if (!has_port) return lose("the port is missing", now);
      reconnect_.opened();
      return start(now);
    }
    if (!bytes.empty()) handle(session_.on_bytes(bytes, now), now);
    if (is_open() && wake_at_ && *wake_at_ <= now) handle(session_.on_time(now), now);
  }

  [[nodiscard]] Session& session() { return session_; }
  [[nodiscard]] unsigned baud() const { return baud_; }
  [[nodiscard]] bool is_open() const { return !try_again_at_; }

 private:
  void set_baud(unsigned baud) {
    if (std::exchange(baud_, baud) != baud && hooks_.on_note) hooks_.on_note(drivers::port::baud_note(baud));
  }
  void lose(const std::string& reason, Timestamp now) {
    wake_at_.reset();
    const drivers::port::Reconnect::Pause pause = reconnect_.failed(reason, now);
    try_again_at_ = pause.try_again_at;
    if (pause.log && hooks_.on_lost) hooks_.on_lost(*pause.log);
  }

  drivers::port::PortId id_;
  Session session_;
  Hooks hooks_;
  unsigned baud_ = 9600;
  std::optional<Timestamp> wake_at_;
  std::optional<Timestamp> try_again_at_;
  drivers::port::Reconnect reconnect_{drivers::port::ReconnectParams{}};
};

}  // namespace deltamap::experiments
