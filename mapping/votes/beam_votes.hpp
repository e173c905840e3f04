// SPDX-License-Identifier: Apache-2.0
// The votes of a keyframe's beams on blocks of cells: "something is new here" where they end off the map, "something is
// gone here" where they went through what it has, and against both where they found it as it is. One vote for each
// block and question.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/grid/tiled.hpp"
#include "mapping/votes/beam_evidence.hpp"
#include "mapping/votes/clear_space.hpp"
#include "mapping/votes/redraw_queue.hpp"
#include "mapping/votes/vote_layer.hpp"

namespace deltamap::mapping::votes {

using Blocks = std::vector<std::uint32_t>;  // by index

/// By question. The yes votes are sorted, all else comes as it was met.
struct Votes {
  Blocks yes[2];
  Blocks no[2];
  Blocks ends;  ///< watched blocks in which beams ended
  Blocks all;   ///< every block above
};

/// The map that a scan's beams vote on: all of the same blocks.
struct VotedMap {
  const ClearSpace& clear;
  const VoteLayer& layer;
  const RedrawQueue& watched;
};

class BeamVotes {
 public:
  /// `gone`: cells of small things that the beams together have shown to be gone. The votes stand until the next
  /// scan's.
  [[nodiscard]] const Votes& of(std::span<const BeamVerdict> beams, std::span<const Cell> gone, const VotedMap& map,
                                double bearing_step_rad);

 private:
  using Marks = std::uint8_t;  // a bit each of the following
  static constexpr Marks kNewHere = 1, kNothingNew = 2, kGone = 4, kStillThere = 8, kWatchedEnd = 16,
                         kLookedAround = 32;

  struct Marked {
    Marks* marks;
    std::uint32_t block;
  };

  [[gnu::always_inline]] void mark(Cell block, Marks what) {
    Marks& marks = marks_.to_write(block);
    if (marks == 0) marked_.push_back({&marks, static_cast<std::uint32_t>(blocks_.index_of(block))});
    marks |= what;
  }
  void mark_beam(const BeamVerdict& beam, const VotedMap& map);
  void mark_still_there(Cell end, const ClearSpace& clear);
  void mark_faces(std::span<const BeamVerdict> beams, const GridGeometry& blocks, double bearing_step_rad);
  void mark_gone_faces(std::span<const BeamVerdict> beams, const VotedMap& map, double bearing_step_rad);
  void mark_gone_between(Cell from, Cell to, const ClearSpace& clear);
  void collect();

  GridGeometry blocks_;
  Tiled<Marks> marks_;          // of every block; none between scans
  std::vector<Marked> marked_;  // blocks with marks, each once
  Votes votes_;
};

}  // namespace deltamap::mapping::votes
