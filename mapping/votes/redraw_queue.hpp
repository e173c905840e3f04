// SPDX-License-Identifier: Apache-2.0
// The queue of regions that were written and are to be drawn again from later keyframes. One that was written from a
// few keyframes gets sharper from more; where one was freed, something may come back. Each region is due after some
// keyframes whose beams end in it, then after three times as many, up to a limit.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/grid/occupancy_grid.hpp"
#include "core/grid/tiled.hpp"

namespace deltamap::mapping::votes {

struct RedrawQueueParams {
  std::uint32_t first_look = 8;      ///< keyframes with beams that end in a region until the next look, …
  std::uint32_t looks = 30;          ///< … so often, after three times as many keyframes each, up to a limit
  std::uint32_t most_watched = 250;  ///< regions; the oldest goes; at most 255
};

/// What is to be looked at now: blocks by index, sorted, and since when their keyframes count.
struct Look {
  std::vector<std::uint32_t> blocks;
  std::uint32_t first_ms = 0;
  bool is_last = false;  ///< of these blocks
};

class RedrawQueue {
 public:
  RedrawQueue() = default;
  RedrawQueue(const RedrawQueueParams& params, const GridGeometry& blocks)
      : params_{params}, geometry_{blocks}, watchers_{blocks.width, blocks.height, 0} {}

  /// Watches the blocks and those within `margin_blocks` of them.
  void watch(const std::vector<std::uint32_t>& blocks, int margin_blocks, std::uint32_t first_ms);

  /// What keyframes saw of these blocks (sorted) before does not count for later looks.
  void begin_anew(const std::vector<std::uint32_t>& blocks, std::uint32_t now_ms);

  /// These blocks (sorted) are not to be looked at again.
  void forget(const std::vector<std::uint32_t>& blocks);

  [[nodiscard]] bool is_watched(Cell block) const { return watchers_[block] > 0; }

  /// The watched blocks in which a keyframe's beams ended.
  void see(std::vector<std::uint32_t> ends);

  /// Of the regions that enough keyframes have seen, the one with the fewest looks so far.
  [[nodiscard]] std::optional<Look> due_look();

 private:
  struct Region {
    Look look;
    std::uint32_t seen = 0;
    std::uint32_t next_look = 0;
    std::uint32_t looks_left = 0;
  };
  void forget(std::vector<Region>::iterator region);

  RedrawQueueParams params_;
  GridGeometry geometry_;
  Tiled<std::uint8_t> watchers_;  // regions that each block belongs to
  std::vector<Region> regions_;   // oldest first
};

}  // namespace deltamap::mapping::votes
