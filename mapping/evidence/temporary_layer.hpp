// SPDX-License-Identifier: Apache-2.0
// The temporary layer: what stands now where M_k has nothing, and what of M_k has been seen gone, long before either is
// proven to last. Blocks enter with the first keyframes that say so, leave when they are seen otherwise, lapse when
// nobody looks, and leave when M_k says the same. Bounded; never written anywhere.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/block_lattice.hpp"
#include "core/occupancy_grid.hpp"
#include "core/temporary_things.hpp"

namespace deltamap::mapping::evidence {

struct TemporaryParams {
  std::uint32_t least_votes = 2;     ///< keyframes that must say so, none of them otherwise; 1..most_votes
  std::uint32_t most_votes = 4;      ///< keyframes that must say otherwise, at most, until a block leaves; 1..255
  double lapse_s = 60.0;             ///< without votes, after which a block leaves, s; > 0
  std::uint32_t most_blocks = 4096;  ///< on each side; beyond, those go that were voted on least recently; > 0
};

class TemporaryLayer {
 public:
  TemporaryLayer() = default;
  TemporaryLayer(const TemporaryParams& params, const BlockLattice& lattice);

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
  [[nodiscard]] const std::shared_ptr<const TemporaryThings>& newest() const { return newest_; }

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
  [[nodiscard]] bool has_occupied(const OccupancyGrid& map, std::uint32_t block, int margin_cells) const;
  void publish(Timestamp time);

  TemporaryParams params_;
  BlockLattice lattice_;
  Entries standing_;
  Entries gone_;
  Entries spare_;                    // memory of the entries before the last keyframe
  std::vector<std::uint32_t> ages_;  // memory of keep_newest()
  std::shared_ptr<const TemporaryThings> newest_;
};

}  // namespace deltamap::mapping::evidence
