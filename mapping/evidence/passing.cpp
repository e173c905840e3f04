// SPDX-License-Identifier: Apache-2.0
#include "mapping/evidence/passing.hpp"

#include <algorithm>
#include <cmath>

namespace deltamap::mapping::evidence {
namespace {

CellBox box_of(const std::vector<ProvenBlock>& region, const votes::VoteLayer& votes) {
  CellBox box;
  for (const ProvenBlock& proven : region) box = united(box, votes.cells_of(proven.block));
  return box;
}

}  // namespace

/// Narrow, and away from everything that the map has, on known floor: a person, a trolley. Where the map knows nothing
/// around it, it may be the part in view of something large.
bool Passing::is_small_and_apart(const std::vector<ProvenBlock>& region, const View& view) const {
  if (region.front().question != votes::Question::kAdded) return false;
  const OccupancyGrid& map = view.map;
  const CellBox box = box_of(region, view.votes);
  if (std::max(box.width(), box.height()) * map.resolution_m() >= params_.small_m) return false;
  const CellBox around = grown(box, static_cast<int>(std::lround(params_.apart_m / map.resolution_m())));
  int unknown = 0;
  for (int row = around.first.row; row < around.last.row; ++row) {
    for (int column = around.first.column; column < around.last.column; ++column) {
      const CellState state = map.at({column, row});
      if (state == CellState::kOccupied) return false;
      unknown += state == CellState::kUnknown ? 1 : 0;
    }
  }
  return unknown <= params_.most_unknown_around * around.width() * around.height();
}

/// A surface that comes back half a block beside is the same.
double Passing::flips_beyond(Cell block, const View& view) const {
  const GridGeometry& blocks = view.votes.blocks();
  double most = -1.0;
  for (int row = block.row - 1; row <= block.row + 1; ++row) {
    for (int column = block.column - 1; column <= block.column + 1; ++column) {
      if (!blocks.contains({column, row})) continue;
      most = std::max(most, flips_.beyond(static_cast<std::uint32_t>(blocks.index_of({column, row})), view.now_ms));
    }
  }
  return most;
}

/// Who goes on toggling has to last twice as long each time.
bool Passing::is_passing(const std::vector<ProvenBlock>& region, const View& view) const {
  double most_flips = -1.0;
  std::ptrdiff_t toggling = 0;
  double longest_s = 0.0;
  for (const ProvenBlock& proven : region) {
    const double flips = flips_beyond(proven.block, view);
    toggling += flips >= 0.0 ? 1 : 0;
    most_flips = std::max(most_flips, flips);
    longest_s = std::max(longest_s, view.votes.ballot(proven.question, proven.block, view.now_ms).span_s());
  }
  if (2 * toggling >= static_cast<std::ptrdiff_t>(region.size()))
    return longest_s < params_.persistence_s * std::exp2(most_flips);
  return longest_s < params_.persistence_s && is_small_and_apart(region, view);
}

}  // namespace deltamap::mapping::evidence
