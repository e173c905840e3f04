// SPDX-License-Identifier: Apache-2.0
// Why regions: a real change covers several blocks at once, while a single block is mostly noise of a pose or of a
// grazing beam. Gaps between blocks are bridged, for beams from afar leave blocks of a face out.
#include "mapping/evidence/evidence_regions.hpp"

#include <cstdlib>

namespace deltamap::mapping::evidence {

std::vector<std::vector<ProvenBlock>> connected_regions(std::span<const ProvenBlock> blocks, int reach_blocks) {
  std::vector<std::vector<ProvenBlock>> regions;
  std::vector<bool> taken(blocks.size(), false);
  const auto touch = [&](const ProvenBlock& a, const ProvenBlock& b) {
    return a.question == b.question && std::abs(a.block.column - b.block.column) <= reach_blocks &&
           std::abs(a.block.row - b.block.row) <= reach_blocks;
  };
  for (std::size_t seed = 0; seed < blocks.size(); ++seed) {
    if (taken[seed]) continue;
    taken[seed] = true;
    std::vector<ProvenBlock> region{blocks[seed]};
    for (std::size_t next = 0; next < region.size(); ++next) {
      for (std::size_t other = seed + 1; other < blocks.size(); ++other) {
        if (taken[other] || !touch(region[next], blocks[other])) continue;
        taken[other] = true;
        region.push_back(blocks[other]);
      }
    }
    regions.push_back(std::move(region));
  }
  return regions;
}

}  // namespace deltamap::mapping::evidence
