// SPDX-License-Identifier: Apache-2.0
// The likelihood field at low resolution: the best value of each block of cells, small enough for the cache. A pose
// somewhere in a block scores here at least about as well as in the field itself, so that a coarse lattice finds every
// pose that is worth a closer look (after Olson, "Real-time correlative scan matching", 2009).
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/grid/block_lattice.hpp"
#include "core/grid/grid_patch.hpp"
#include "localization/motion/deskew.hpp"
#include "localization/sensor/likelihood_field.hpp"
#include "localization/sensor/quad_bounds.hpp"
#include "localization/sensor/turned_beams.hpp"

namespace deltamap::localization::sensor {

/// Its blocks are those that the field's window touches, counted from there.
class CoarseField {
 public:
  /// Blocks of about `block_m`; at least one cell.
  CoarseField(const OccupancyGrid& map, const LikelihoodField& field, double block_m);

  /// Looks again at the blocks that the box of changed cells touches; at all where the field's window has grown.
  void update(const OccupancyGrid& map, const LikelihoodField& field, const CellBox& changed);

  /// Blocks in whose middle a robot may stand: one of the cells there is free. Rising.
  [[nodiscard]] std::span<const std::uint32_t> free_blocks() const { return free_blocks_; }
  [[nodiscard]] bool is_free(int column, int row) const {
    if (column >= columns_ || row >= rows_) return false;
    return free_[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(column)];
  }
  [[nodiscard]] Point2 centre_of(std::uint32_t block) const;
  [[nodiscard]] double middle_of_row(int row) const { return origin_.y() + (row + 0.5) * block_m_; }
  /// Places in free_blocks(), from `first` to before `past`.
  struct Run {
    std::size_t first = 0;
    std::size_t past = 0;
  };
  /// The free blocks of a row whose middles lie between these x, m.
  [[nodiscard]] Run free_in_row(int row, double from_m, double to_m) const;
  [[nodiscard]] double block_m() const { return block_m_; }
  [[nodiscard]] int columns() const { return columns_; }
  [[nodiscard]] int rows() const { return rows_; }

  /// Four blocks, from the one at twice this column and row on.
  struct Quad {
    std::int16_t column = 0;
    std::int16_t row = 0;
  };
  /// In which one block at least is free. Row by row from the lowest.
  [[nodiscard]] std::span<const Quad> free_quads() const { return free_quads_; }
  [[nodiscard]] const QuadBounds& quads() const { return quads_; }

  static constexpr int kAtOnce = 16;  ///< blocks side by side that are looked at together

  /// The bytes of a block and the kAtOnce - 1 to its right, in steps as in LikelihoodField; unknown outside the map.
  [[nodiscard]] const std::uint8_t* from(int column, int row) const {
    return bytes_.data() + static_cast<std::ptrdiff_t>(std::clamp(row, -1, rows_) + 1) * padded_columns() +
           std::clamp(column, -kAtOnce, columns_) + kAtOnce;
  }
  /// The same for all beams of a robot in the block, as places in bytes(). Of beams beyond the count: any place.
  using Places = std::array<std::int32_t, TurnedBeams::kMost>;
  [[nodiscard]] Places places_of(const TurnedBeams& beams, int column, int row) const;
  [[nodiscard]] const std::uint8_t* bytes() const { return bytes_.data(); }
  [[nodiscard]] Point2 origin() const { return origin_; }

 private:
  /// The cells of one of the window's blocks.
  [[nodiscard]] CellBox cells_of(int column, int row) const {
    return lattice_.cells_of({first_block_.column + column, first_block_.row + row});
  }
  [[nodiscard]] bool is_free(const OccupancyGrid& map, int column, int row) const;
  [[nodiscard]] int padded_columns() const { return columns_ + 2 * kAtOnce; }
  void look_at(const OccupancyGrid& map, const LikelihoodField& field, int column, int row);
  void list_free_blocks();

  BlockLattice lattice_;  // of the map
  double block_m_;
  CellBox window_;    // of the field, cells
  Cell first_block_;  // of the lattice: the window's
  int columns_;
  int rows_;
  Point2 origin_;
  std::vector<std::uint8_t> bytes_;  // rows with one unknown row on each side, and kAtOnce unknown columns
  std::vector<bool> free_;
  std::vector<std::uint32_t> free_blocks_;
  QuadBounds quads_;
  std::vector<Quad> free_quads_;
};

/// Sums of the field's steps over the beams with the robot in the middle of the block, and of those to its right.
/// Places beyond the end of the row say nothing.
using CoarseMisfits = std::array<std::uint16_t, CoarseField::kAtOnce>;
[[nodiscard]] CoarseMisfits coarse_misfits(const CoarseField& field, const TurnedBeams& beams, std::uint32_t block);

}  // namespace deltamap::localization::sensor
