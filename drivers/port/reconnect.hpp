// SPDX-License-Identifier: Apache-2.0
// When to try a device again, and what to say about it: the pause grows up to a cap while the port does not even open,
// and a reason is told once, not at every try. Knows no port and no timer.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>

#include "core/time.hpp"

namespace deltamap::drivers::port {

struct ReconnectParams {
  double first_pause_s = 0.5;    ///< after the first failure, and whenever the port had opened; > 0
  double growth = 2.0;           ///< of the pause from try to try; >= 1
  double longest_pause_s = 1.0;  ///< >= first_pause_s; looking for a device costs little, waiting for it much
};

class Reconnect {
 public:
  explicit Reconnect(const ReconnectParams& params) : params_{params} {}

  struct Pause {
    Timestamp try_again_at;
    std::optional<std::string> log;  ///< the reason, where it is another one than at the last try
  };
  [[nodiscard]] Pause failed(std::string reason, Timestamp now);

  /// The port is open: the device may be back, so the next pause is a short one.
  void opened() { pause_s_ = 0.0; }

  /// The device works (its session is up, not merely its port open). Answers what to log where it had failed before.
  [[nodiscard]] std::optional<std::string> connected();

  /// Failures since it last worked.
  [[nodiscard]] std::uint64_t failures() const { return failures_; }

 private:
  ReconnectParams params_;
  double pause_s_ = 0.0;  // the last one; 0: begin with the first
  std::uint64_t failures_ = 0;
  std::string told_;
};

}  // namespace deltamap::drivers::port
