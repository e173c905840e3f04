// SPDX-License-Identifier: Apache-2.0
// Gathers blocks that have proven to differ from the map into connected regions.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "mapping/votes/vote_layer.hpp"

namespace deltamap::mapping::evidence {

/// A block whose ballot has been decided and that waits to be written.
struct ProvenBlock {
  votes::Question question = votes::Question::kAdded;
  Cell block;
  std::uint32_t since_ms = 0;  ///< when it was decided
};

/// Blocks of one question, each within `reach_blocks` (rows and columns) of another. In the order of their first
/// member.
[[nodiscard]] std::vector<std::vector<ProvenBlock>> connected_regions(std::span<const ProvenBlock> blocks,
                                                                      int reach_blocks);

}  // namespace deltamap::mapping::evidence
