// SPDX-License-Identifier: Apache-2.0
// The change to a faster line, once connected and where the robot's AUTOBAUD allows it (protocols.md A4.8): HOSTBAUD, a
// pause, the new speed, a pause, PULSE, any packet; without one the old speed again.
#pragma once

#include "core/time.hpp"
#include "drivers/pioneer/transmitter.hpp"

namespace deltamap::drivers::pioneer {

class BaudSwitch {
 public:
  /// 0: never.
  explicit BaudSwitch(unsigned fast_baud) : fast_baud_{fast_baud} {}

  /// Another connection: it may be tried again.
  void forget() { was_tried_ = false; }
  [[nodiscard]] bool is_due(const Receiver& receiver) const;
  void begin(Transmitter& line);
  void hear_packet(Transmitter& line);
  /// Called whenever it may be late: the steps also depend on the queue.
  void time_out(Transmitter& line);

  [[nodiscard]] unsigned fast_baud() const { return fast_baud_; }
  [[nodiscard]] Timestamp deadline() const { return deadline_; }
  [[nodiscard]] bool is_over() const { return step_ == Step::kOver; }

 private:
  enum class Step { kAnnounced, kSpeedSet, kAwaitingPacket, kOver };

  unsigned fast_baud_;
  unsigned slow_baud_ = 0;
  bool was_tried_ = false;  // in this connection
  Step step_ = Step::kOver;
  Timestamp deadline_;  // of the present step
};

}  // namespace deltamap::drivers::pioneer
