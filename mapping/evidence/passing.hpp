// SPDX-License-Identifier: Apache-2.0
// Tells what only passes from what has come or gone for good: somebody who stands for a while, a trolley, a door, a
// pane that some beams miss. It has to be seen for longer before the map takes it in.
#pragma once

#include <cstdint>
#include <vector>

#include "core/grid/occupancy_grid.hpp"
#include "mapping/evidence/evidence_regions.hpp"
#include "mapping/votes/flip_memory.hpp"
#include "mapping/votes/vote_layer.hpp"

namespace deltamap::mapping::evidence {

struct PassingParams {
  double persistence_s = 120.0;  ///< votes on a small free-standing thing, or on what toggles, must span at least so
                                 ///< long; >= 0 (mapping.persistence_s)
  double small_m = 1.0;          ///< wider is no small thing; >= 0
  double apart_m = 0.25;         ///< free-standing: farther than this from every surface of the map, …
  double most_unknown_around = 0.4;  ///< … and on known floor: no larger share of what is around it is unknown; [0, 1]
  votes::FlipParams flips;
};

class Passing {
 public:
  Passing() = default;
  explicit Passing(const PassingParams& params) : params_{params}, flips_{params.flips} {}

  /// The block is about to be written as that question's "yes".
  void note(std::uint32_t block, votes::Question question, std::uint32_t now_ms) {
    flips_.note(block, question, now_ms);
  }

  struct View {
    const OccupancyGrid& map;
    const votes::VoteLayer& votes;
    std::uint32_t now_ms;
  };
  /// Has the region not been voted for long enough to tell it from what only passes?
  [[nodiscard]] bool is_passing(const std::vector<ProvenBlock>& region, const View& view) const;

 private:
  [[nodiscard]] double flips_beyond(Cell block, const View& view) const;
  [[nodiscard]] bool is_small_and_apart(const std::vector<ProvenBlock>& region, const View& view) const;

  PassingParams params_;
  votes::FlipMemory flips_;
};

}  // namespace deltamap::mapping::evidence
