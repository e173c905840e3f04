// SPDX-License-Identifier: Apache-2.0
// The transient layer: blocks of cells in which something stands where M_k has nothing, or in which what M_k has was
// seen gone, long before either is proven to last. A block enters with the first keyframes that say so. It leaves when
// it is seen otherwise, when nobody looks for long, and when M_k says the same. Bounded in size; never written to disk.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/grid/block_lattice.hpp"
#include "core/grid/occupancy_grid.hpp"
#include "core/transient_obstacles.hpp"

namespace deltamap::mapping::evidence {

struct TransientLayerParams {
  std::uint32_t least_votes = 2;     ///< keyframes that must say so, none of them otherwise; 1..most_votes
  std::uint32_t most_votes = 4;      ///< keyframes that must say otherwise, at most, until a block leaves; 1..255
  double lapse_s = 60.0;             ///< without votes, after which a block leaves, s; > 0
  std::uint32_t most_blocks = 4096;  ///< on each side; beyond, those go that were voted on least recently; > 0
};

class TransientLayer {
 public:
  TransientLayer() = default;
  TransientLayer(const TransientLayerParams& params, const BlockLattice& lattice);

  /// What one keyframe says of blocks, by index: yes (ascending) and no (in any order) of "something is new here" and
  /// "something has gone here".
  struct Votes {
    std::span<const std::uint32_t> added, not_added, removed, not_removed;
  };
  void observe(const Votes& votes, Timestamp time, std::uint32_t now_ms);

  /// The map has changed: what it says by now is no longer temporary.
  void follow(const OccupancyGrid& map);
  /// The pose is in doubt: what is known stays, but nobody is told of it until the next keyframe.
  void hide(Timestamp time);
  /// The pose was wrong: nothing is known.
  void clear();

  /// The newest snapshot; another one only where it differs. Null until there was anything to tell.
  [[nodiscard]] const std::shared_ptr<const TransientObstacles>& newest() const { return newest_; }

 private:
  struct Entry {
    std::uint32_t block;
    std::uint32_t last_ms;  // of any vote
    std::uint8_t votes;     // yes less no; in [1, most_votes]
    bool is_shown;          // has had least_votes
  };
  using Entries = std::vector<Entry>;  // by block, ascending

  static void vote_no(Entries& entries, std::span<const std::uint32_t> blocks, std::uint32_t now_ms);
  void vote_yes(Entries& entries, std::span<const std::uint32_t> blocks, std::uint32_t now_ms);
  void keep_newest(Entries& entries, std::uint32_t now_ms);
  void publish(Timestamp time);

  TransientLayerParams params_;
  BlockLattice lattice_;
  Entries standing_;
  Entries gone_;
  Entries spare_;                    // memory of the entries before the last keyframe
  std::vector<std::uint32_t> ages_;  // memory of keep_newest()
  std::shared_ptr<const TransientObstacles> newest_;
};

}  // namespace deltamap::mapping::evidence
