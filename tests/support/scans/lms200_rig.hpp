// SPDX-License-Identifier: Apache-2.0
// A simulated laser scanner with a host's decoder at the other end of its line, in virtual time.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <utility>
#include <vector>

#include "drivers/lms200/command.hpp"
#include "drivers/lms200/telegram.hpp"
#include "simulation/devices/virtual_lms200.hpp"

namespace deltamap::simulation::devices {

namespace lms200 = drivers::lms200;

inline constexpr Timestamp kPowerOn = timestamp_from_ns(1'000'000'000'000);

class Lms200Rig {
 public:
  explicit Lms200Rig(const Lms200Setup& setup = {})
      : laser{setup, kPowerOn, Random{1}}, host_baud{setup.baud}, decoder_{lms200::Sender::kDevice, setup.baud} {}

  /// Looks at the line whenever a burst is whole, and at least every 5 ms.
  std::vector<lms200::Telegram> pass(double seconds) {
    std::vector<lms200::Telegram> telegrams;
    for (const Timestamp end = now + duration_from_seconds(seconds); now < end;) {
      Timestamp next = std::min(end, now + std::chrono::milliseconds{5});
      if (const auto event = laser.next_event(); event && *event > now) next = std::min(next, *event);
      now = next;
      laser.advance(now, [&](const SweepRequest& request) {
        sweeps.push_back(request);
        return std::vector<Beam>(request.variant.values(), Beam{range_m, 0.0F, kind});
      });
      const auto bytes = laser.transmitted(now, host_baud);
      for (auto& telegram : decoder_.decode(bytes, now)) telegrams.push_back(std::move(telegram));
    }
    return telegrams;
  }
  std::vector<lms200::Telegram> ask(const std::vector<std::uint8_t>& request, double seconds = 0.5) {
    laser.receive(request, host_baud, now);
    return pass(seconds);
  }
  void set_host_baud(unsigned baud) {
    host_baud = baud;
    decoder_.set_baud(baud);
  }
  /// Gives up a half telegram, as a host does that has told the stream to stop.
  void discard_input() { (void)decoder_.finish(); }
  void stream() { ASSERT_GE(ask(lms200::mode_request(lms200::mode::kStreamAll), 0.12).size(), 2u); }

  VirtualLms200 laser;
  unsigned host_baud;
  Timestamp now = kPowerOn + std::chrono::seconds{1};
  float range_m = 5.0F;
  BeamKind kind = BeamKind::kRange;
  std::vector<SweepRequest> sweeps;

 private:
  lms200::TelegramDecoder decoder_;
};

/// The data of the one answer after the ACK.
inline lms200::Telegram answer_of(Lms200Rig& rig, const std::vector<std::uint8_t>& request, double seconds = 2.0) {
  const auto answers = rig.ask(request, seconds);
  EXPECT_EQ(answers.size(), 2u);
  return answers.size() == 2 ? answers[1] : lms200::Telegram{};
}

}  // namespace deltamap::simulation::devices
