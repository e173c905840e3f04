// SPDX-License-Identifier: Apache-2.0
// The pose of every localized scan as a line of JSON on a Unix socket, for a planner in another process (docs/api.md).
#pragma once

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
  PoseStream(const Settings& settings, const Telemetry& telemetry);

  /// Localization thread. Never waits: where nobody listens, or the stream's thread is far behind, nothing is sent.
  void show(const LocalizationRow& row, double latency_s);

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
  Channel<PoseNews> news_{64};
  LoopPulse pulse_;
  sockets::LineStream lines_;  // last: it takes from the channel
};

/// Null where the settings name no socket, or it cannot be had: that is warned of. Throws sockets::AlreadyServed.
[[nodiscard]] std::unique_ptr<PoseStream> begun_pose_stream(const Settings& settings, const Telemetry& telemetry,
                                                            const std::function<void(const std::string&)>& warn);

}  // namespace deltamap::daemon
