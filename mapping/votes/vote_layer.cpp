// SPDX-License-Identifier: Apache-2.0
// Why votes wear away: by plain sums a wall that was seen for an hour would need an hour of contrary votes. Worn and
// capped, a change is proven after a few keyframes, whatever was seen before it.
#include "mapping/votes/vote_layer.hpp"

#include <algorithm>
#include <cmath>

namespace deltamap::mapping::votes {
namespace {

constexpr float kNobody = 0.1F;  // worn votes that count for nothing

}  // namespace

VoteLayer::VoteLayer(const VoteLayerParams& params, const GridGeometry& map) : params_{params} {
  lattice_ = {map, std::max(1, static_cast<int>(std::lround(params.block_m / map.resolution_m)))};
  const GridGeometry& blocks = lattice_.blocks();
  open_ = Tiled<std::uint8_t>{blocks.width, blocks.height, 0};
  places_ = {blocks.width / kTileSide + 1, blocks.height / kTileSide + 1, blocks.resolution_m * kTileSide,
             blocks.origin};
  opened_.assign(places_.cell_count(), 0);
  tile_of_.assign(places_.cell_count(), -1);
}

Ballot VoteLayer::ballot(Question question, Cell block, std::uint32_t now_ms) const {
  const std::int32_t tile = tile_of_[place_of(block)];
  if (tile < 0) return {};
  Ballot ballot = tiles_[static_cast<std::size_t>(tile)].ballots[static_cast<std::size_t>(question)][slot_of(block)];
  if (is_void(ballot, now_ms)) ballot.yes = 0.0F;
  return ballot;
}

bool VoteLayer::is_void(const Ballot& ballot, std::uint32_t now_ms) const {
  return ballot.last_ms != 0 && 1e-3 * (now_ms - ballot.last_ms) > params_.forget_s;
}

VoteLayer::Tile& VoteLayer::tile_for(Cell block, std::uint32_t now_ms) {
  const std::size_t place = place_of(block);
  if (tile_of_[place] < 0) {
    if (tiles_.size() < params_.most_tiles) {
      tile_of_[place] = static_cast<std::int32_t>(tiles_.size());
      tiles_.emplace_back();
    } else {
      const auto oldest = std::min_element(tiles_.begin(), tiles_.end(),
                                           [](const Tile& a, const Tile& b) { return a.last_ms < b.last_ms; });
      tile_of_[oldest->place] = -1;
      empty_tile(*oldest);
      tile_of_[place] = static_cast<std::int32_t>(oldest - tiles_.begin());
    }
    tiles_[static_cast<std::size_t>(tile_of_[place])].place = static_cast<std::uint32_t>(place);
  }
  Tile& tile = tiles_[static_cast<std::size_t>(tile_of_[place])];
  tile.last_ms = now_ms;
  return tile;
}

void VoteLayer::set_open(Cell block, int bits) {
  const std::uint8_t open = open_[block];
  std::uint8_t& opened = opened_[place_of(block)];
  const std::uint8_t added = bit_of(Question::kAdded);
  if ((open & added) != (bits & added))
    opened = static_cast<std::uint8_t>((bits & added) != 0 ? opened + 1 : opened - 1);
  open_.set(block, static_cast<std::uint8_t>(bits));
}

void VoteLayer::empty_tile(Tile& tile) {
  const Cell place = places_.cell_of(tile.place);
  const Cell first{place.column * kTileSide, place.row * kTileSide};
  for (int row = first.row; row < std::min(first.row + kTileSide, blocks().height); ++row) {
    for (int column = first.column; column < std::min(first.column + kTileSide, blocks().width); ++column) {
      set_open({column, row}, 0);
    }
  }
  tile = Tile{};
}

void VoteLayer::vote(Question question, Cell block, bool yes, std::uint32_t now_ms) {
  Ballot& ballot = tile_for(block, now_ms).ballots[static_cast<std::size_t>(question)][slot_of(block)];
  if (ballot.yes > 0.0F && is_void(ballot, now_ms)) ballot.yes = 0.0F;
  const auto most = static_cast<float>(params_.most_votes);
  const auto left = static_cast<float>(1.0 - params_.wear);
  if (yes) {
    if (ballot.yes < 0.5F) ballot.first_ms = now_ms;
    ballot.yes = std::min(most, ballot.yes + 1.0F);
    ballot.no *= left;
    if (!is_open(question, block)) set_open(block, open_[block] | bit_of(question));
  } else {
    ballot.no = std::min(most, ballot.no + 1.0F);
    ballot.yes *= left;
    if (ballot.no >= most && ballot.yes < kNobody && is_open(question, block))
      set_open(block, open_[block] & ~bit_of(question));
  }
  ballot.last_ms = now_ms;
}

void VoteLayer::reset(Question question, Cell block) {
  set_open(block, open_[block] & ~bit_of(question));
  const std::int32_t tile = tile_of_[place_of(block)];
  if (tile >= 0)
    tiles_[static_cast<std::size_t>(tile)].ballots[static_cast<std::size_t>(question)][slot_of(block)] = {};
}

void VoteLayer::reset(const CellBox& cells) {
  const CellBox voided = lattice_.blocks_of(cells);
  for (int row = voided.first.row; row < voided.last.row; ++row) {
    for (int column = voided.first.column; column < voided.last.column; ++column) {
      reset(Question::kAdded, {column, row});
      reset(Question::kRemoved, {column, row});
    }
  }
}

}  // namespace deltamap::mapping::votes
