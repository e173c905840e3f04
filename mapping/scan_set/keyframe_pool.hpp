// SPDX-License-Identifier: Apache-2.0
// The scans that have voted, the newest of them, each with the blocks that it voted on: what a region of change is
// later drawn from.
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <vector>

#include "core/messages.hpp"

namespace deltamap::mapping::scan_set {

struct KeyframeParams {
  double moved_m = 0.15;           ///< a scan is a keyframe when the robot has moved so far since the last one, …
  double turned_rad = 0.17;        ///< … or turned so far (10°), …
  double waited_s = 0.5;           ///< … or waited so long
  std::uint32_t most_kept = 160;   ///< keyframes; 8 kB each at 181 beams; > 0
  std::uint32_t most_in_set = 40;  ///< keyframes of one S(k), the newest that saw the region; > 0
};

struct Keyframe {
  std::shared_ptr<const TrackedScan> tracked;  ///< without its map
  std::vector<std::uint32_t> blocks;           ///< that it voted on
};

class KeyframePool {
 public:
  explicit KeyframePool(const KeyframeParams& params) : params_{params} {}

  [[nodiscard]] bool is_due(const TrackedScan& tracked) const;
  /// Keeps the scan, and forgets the oldest and those of another odometry epoch.
  void keep(const TrackedScan& tracked, std::vector<std::uint32_t> blocks);
  /// The newest keyframes since `since` that voted on one of the blocks, in order of time.
  [[nodiscard]] KeptScans that_saw(const std::vector<std::uint32_t>& blocks, Timestamp since) const;

 private:
  KeyframeParams params_;
  std::deque<Keyframe> kept_;
};

}  // namespace deltamap::mapping::scan_set
