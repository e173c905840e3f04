// SPDX-License-Identifier: Apache-2.0
// The pose of every localized scan as a line of JSON on a Unix socket, for a planner in another process, and for those
// who ask for it what becomes of things and bays (docs/api.md).
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <utility>

#include "core/channel.hpp"
#include "daemon/live/pose_line.hpp"
#include "daemon/settings/settings.hpp"
#include "daemon/sockets/line_stream.hpp"
#include "daemon/telemetry/loop_pulse.hpp"
#include "daemon/telemetry/telemetry.hpp"

namespace deltamap::daemon {

class PoseStream {
 public:
  /// Listens from now on. Throws sockets::AlreadyServed, or std::runtime_error with one line that names the socket.
  PoseStream(const Settings& settings, const Telemetry& telemetry, std::function<void(const std::string&)> warn);

  /// Localization thread. Never waits: where nobody listens, or the stream's thread is far behind, nothing is sent.
  void show(const LocalizationRow& row, double latency_s);

  enum class EventKind : std::uint8_t { kThing, kBay };
  /// Map thread, never waits: a line of things.jsonl or bays.jsonl. Who asked for it is told how many are missing where
  /// the stream's thread is far behind.
  void tell(EventKind kind, std::string line);

  /// The thread's work, until stop().
  void run() { lines_.run(); }
  void stop() { lines_.stop(); }
  /// Any one thread, now and then: for how long the stream's thread owes an answer.
  [[nodiscard]] double silence_s() {
    return pulse_.silence_s([this](auto work) { lines_.post(std::move(work)); });
  }

 private:
  bool mapping_enabled_;
  const Telemetry& telemetry_;
  struct Event {
    EventKind kind;
    std::string line;
  };
  [[nodiscard]] std::optional<sockets::LineStream::Line> next();

  Channel<PoseNews> news_{64};
  Channel<Event> events_{256};
  std::atomic<std::uint64_t> events_lost_{0};
  std::uint64_t losses_told_ = 0;  // the stream's thread
  LoopPulse pulse_;
  sockets::LineStream lines_;  // last: it takes from the channel
};

/// Null where the settings name no socket, or it cannot be had: that is warned of. Throws sockets::AlreadyServed.
[[nodiscard]] std::unique_ptr<PoseStream> begun_pose_stream(const Settings& settings, const Telemetry& telemetry,
                                                            const std::function<void(const std::string&)>& warn);

}  // namespace deltamap::daemon
