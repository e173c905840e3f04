// SPDX-License-Identifier: Apache-2.0
// Where the keyframes' votes against the map are kept: two ballots a block of cells (something new stands here; what
// the map has is gone), in tiles that exist only where somebody has voted. New votes wear old ones of the other side
// away.
#pragma once

#include <cstdint>
#include <deque>
#include <span>
#include <utility>
#include <vector>

#include "core/grid/block_lattice.hpp"
#include "core/grid/grid_patch.hpp"
#include "core/grid/grid_ray.hpp"
#include "core/grid/occupancy_grid.hpp"
#include "core/grid/tiled.hpp"

namespace deltamap::mapping::votes {

struct VoteLayerParams {
  double block_m = 0.1;      ///< side of a block; at least one cell
  double wear = 0.2;         ///< share of the other side's votes that a vote wears away; [0, 1)
  double most_votes = 20.0;  ///< a side holds at most so many; > 0
  double forget_s = 300.0;   ///< yes votes on a ballot without votes for so long are void; > 0
  std::uint32_t most_tiles =
      4096;  ///< of 8 × 8 blocks, 2 kB each; beyond, the tile that was voted on least recently goes
};

enum class Question : std::uint8_t {
  kAdded,   ///< does something stand where the map has nothing?
  kRemoved  ///< is gone what the map has?
};

/// One question about one block.
struct Ballot {
  float yes = 0.0F;
  float no = 0.0F;
  std::uint32_t first_ms = 0;  ///< of the present row of yes votes
  std::uint32_t last_ms = 0;   ///< of any vote

  [[nodiscard]] double share() const { return yes <= 0.0F ? 0.0 : static_cast<double>(yes / (yes + no)); }
  [[nodiscard]] double span_s() const { return 1e-3 * static_cast<double>(last_ms - first_ms); }
};

class VoteLayer {
 public:
  VoteLayer() = default;
  VoteLayer(const VoteLayerParams& params, const GridGeometry& map);

  /// Blocks lie on the map like cells of their own grid.
  [[nodiscard]] const GridGeometry& blocks() const { return lattice_.blocks(); }
  [[nodiscard]] const BlockLattice& lattice() const { return lattice_; }
  [[nodiscard]] Cell block_of(Cell cell) const { return lattice_.block_of(cell); }
  [[nodiscard]] CellBox cells_of(Cell block) const { return lattice_.cells_of(block); }

  /// Has anybody said yes to the question in this block, and not been outvoted as often as it counts since?
  [[nodiscard]] bool is_open(Question question, Cell block) const { return (open_[block] & bit_of(question)) != 0; }
  /// `visit(Cell block)` for those that the segment touches in which somebody has said "added"; most of the way there
  /// is none, and it is passed in places of many blocks. `from` lies on the map, or none is visited.
  template <typename Visit>
  void walk_open(const Point2& from, const Point2& to, Visit&& visit) const;
  /// Without the yes votes that are void by now.
  [[nodiscard]] Ballot ballot(Question question, Cell block, std::uint32_t now_ms) const;

  /// A "no" where nobody has said "yes" yet counts too: what has often been confirmed is hard to overturn.
  void vote(Question question, Cell block, bool yes, std::uint32_t now_ms);
  void reset(Question question, Cell block);
  /// Both questions of every block that touches the box of cells.
  void reset(const CellBox& cells);

 private:
  static constexpr int kTileSide = 8;
  struct Tile {
    Ballot ballots[2][kTileSide * kTileSide];
    std::uint32_t last_ms = 0;
    std::uint32_t place = 0;  // index into places_
  };

  [[nodiscard]] static std::uint8_t bit_of(Question question) {
    return static_cast<std::uint8_t>(1U << static_cast<unsigned>(question));
  }
  [[nodiscard]] std::size_t place_of(Cell block) const {
    return places_.index_of({block.column / kTileSide, block.row / kTileSide});
  }
  [[nodiscard]] static std::size_t slot_of(Cell block) {
    return static_cast<unsigned>(block.row) % kTileSide * kTileSide + static_cast<unsigned>(block.column) % kTileSide;
  }
  void set_open(Cell block, int bits);
  [[nodiscard]] Tile& tile_for(Cell block, std::uint32_t now_ms);
  void empty_tile(Tile& tile);
  [[nodiscard]] bool is_void(const Ballot& ballot, std::uint32_t now_ms) const;

  VoteLayerParams params_;
  BlockLattice lattice_;
  Tiled<std::uint8_t> open_;           // a bit a question, for each block
  GridGeometry places_;                // of tiles
  std::vector<std::uint8_t> opened_;   // blocks in a place in which somebody has said "added"
  std::vector<std::int32_t> tile_of_;  // of a place, index into tiles_, -1 = none
  std::deque<Tile> tiles_;             // never moved: growing costs no second copy
};

template <typename Visit>
void VoteLayer::walk_open(const Point2& from, const Point2& to, Visit&& visit) const {
  const double length_m = (to - from).norm();
  const auto walk_blocks = [&](double since_m, double until_m) {
    const auto at = [&](double way_m) { return Point2{from + (to - from) * (way_m / length_m)}; };
    walk_ray(blocks(), since_m > 0.0 ? at(since_m) : from, until_m < length_m ? at(until_m) : to,
             [&](Cell block, double) {
               if (!blocks().contains(block)) return false;
               if (is_open(Question::kAdded, block)) visit(block);
               return true;
             });
  };
  constexpr double kInNone = -1.0;
  double since_m = kInNone;  // where the beam has come into places in which somebody has said "added"
  walk_ray(places_, from, to, [&](Cell place, double entered_m) {
    if (!places_.contains(place)) return false;
    const bool has_open = opened_[places_.index_of(place)] != 0;
    if (has_open && since_m == kInNone) since_m = entered_m;
    if (!has_open && since_m != kInNone) walk_blocks(std::exchange(since_m, kInNone), entered_m);
    return true;
  });
  if (since_m != kInNone) walk_blocks(since_m, length_m);
}

}  // namespace deltamap::mapping::votes
