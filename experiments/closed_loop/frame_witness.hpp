// SPDX-License-Identifier: Apache-2.0
// Knows every frame that the devices of a simulation have sent, as it was before the line damaged it, and holds against
// them what decoders and drivers make of the bytes that arrive.
#pragma once

#include <deque>
#include <set>
#include <span>
#include <vector>

#include "core/messages.hpp"
#include "drivers/lms200/telegram.hpp"
#include "drivers/pioneer/packet.hpp"
#include "simulation/simulation.hpp"

namespace deltamap::experiments {

class FrameWitness {
 public:
  /// Listens to its devices from now on; they must outlive it, and it must not move.
  FrameWitness(simulation::Simulation& devices, double max_range_m);
  FrameWitness(const FrameWitness&) = delete;
  FrameWitness& operator=(const FrameWitness&) = delete;

  /// What reaches the host.
  void hear(std::span<const std::uint8_t> from_robot, std::span<const std::uint8_t> from_laser, Timestamp now);
  /// A scan that the driver gives.
  void judge(const Scan& scan);

  [[nodiscard]] int wrong_frames() const { return wrong_frames_; }
  [[nodiscard]] int wrong_scans() const { return wrong_scans_; }

 private:
  using Frame = std::vector<std::uint8_t>;
  void keep_scan(std::span<const std::uint8_t> frame, Timestamp now);

  simulation::Simulation& devices_;
  double max_range_m_;
  std::set<Frame> sent_;
  std::deque<std::vector<Beam>> measured_;  // the newest
  drivers::pioneer::PacketDecoder packets_;
  drivers::lms200::TelegramDecoder telegrams_;
  int wrong_frames_ = 0;
  int wrong_scans_ = 0;
};

}  // namespace deltamap::experiments
