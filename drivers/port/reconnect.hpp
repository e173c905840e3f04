// SPDX-License-Identifier: Apache-2.0
// When to try a device again, and what to say about it: the pause grows from try to try up to a cap, and a reason is
// told once, not at every try. Knows no port and no timer.
#pragma once

#include <optional>
#include <string>
#include <utility>

#include "core/time.hpp"

namespace deltamap::drivers::port {

struct ReconnectParams {
  double first_pause_s = 0.5;    ///< after the first failure; > 0
  double growth = 2.0;           ///< of the pause from try to try; >= 1
  double longest_pause_s = 8.0;  ///< >= first_pause_s
};

class Reconnect {
 public:
  explicit Reconnect(const ReconnectParams& params) : params_{params} {}

  struct Pause {
    Timestamp try_again_at;
    std::optional<std::string> log;  ///< the reason, where it is another one than at the last try
  };
  [[nodiscard]] Pause failed(std::string reason, Timestamp now);

  /// The device works (its session is up, not merely its port open). Answers what to log where it had failed before.
  [[nodiscard]] std::optional<std::string> connected();

  /// Failures since it last worked.
  [[nodiscard]] int failures() const { return failures_; }

 private:
  ReconnectParams params_;
  double pause_s_ = 0.0;
  int failures_ = 0;
  std::string told_;
};

}  // namespace deltamap::drivers::port
