// SPDX-License-Identifier: Apache-2.0
// Keyframes taken while the write gate was shut though nothing had proven the pose wrong; somebody may just have taken
// a container away in front of the robot. They vote once the gate is open again, or never.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>

#include "core/messages.hpp"
#include "mapping/scan_set/keyframe_pool.hpp"

namespace deltamap::mapping::scan_set {

class WaitingScans {
 public:
  /// Keeps `most` at most; beyond, the oldest go. 8 kB each at 181 beams.
  WaitingScans(const KeyframeParams& keyframes, std::uint32_t most) : keyframes_{keyframes}, most_{most} {}

  [[nodiscard]] bool empty() const { return scans_.empty(); }
  /// Keeps the scan if it is a keyframe.
  void keep(const TrackedScan& tracked);
  void clear() { scans_.clear(); }
  /// The oldest, as if it had been taken on the map on which `now` was; nothing where none waits.
  [[nodiscard]] std::optional<TrackedScan> next(const Estimate& now);

 private:
  KeyframeParams keyframes_;
  std::uint32_t most_;
  std::deque<TrackedScan> scans_;
};

}  // namespace deltamap::mapping::scan_set
