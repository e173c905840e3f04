// SPDX-License-Identifier: Apache-2.0
// Which tiles of the map have proven to stay. A tile rises by a confirmation from a new position after a while, falls
// where a beam goes through it, and begins again where a revision rewrites it; nothing is assumed of the first map.
// Beams on proven tiles tell more of the pose than others do (pose_verdict.hpp).
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "core/grid/block_lattice.hpp"
#include "core/grid/grid_patch.hpp"
#include "core/grid/occupancy_grid.hpp"
#include "core/grid/tiled.hpp"
#include "core/time.hpp"
#include "localization/belief/stability_record.hpp"

namespace deltamap::localization::belief {

class Stability {
 public:
  explicit Stability(const GridGeometry& geometry);

  /// A beam from `seen_from` has ended where the map has this cell. Call only while the pose is well known.
  void confirm(Cell cell, const Point2& seen_from, Timestamp time);
  /// A beam has gone through this cell, which the map has as an obstacle; the same condition.
  void refute(Cell cell, const Point2& seen_from, Timestamp time);
  /// Cells that a revision has rewritten.
  void forget(std::span<const CellChange> changes);

  /// Confirmed often enough and from two directions at least; false outside the map.
  [[nodiscard]] bool proven(Cell cell) const;
  [[nodiscard]] std::size_t proven_tiles() const;

  [[nodiscard]] StabilityRecord record() const;
  /// Takes a record of a map of the same geometry; refuses any other and stays as it is.
  [[nodiscard]] bool restore(const StabilityRecord& record);

 private:
  struct Tile {
    std::uint8_t level = 0;       ///< counted confirmations, up to kMostLevel
    std::uint8_t directions = 0;  ///< a bit for each eighth of the circle that it was confirmed from
    std::uint8_t place = 0;   ///< of the last count: 4 bits of column and row in units of half the distance that counts
    std::uint8_t moment = 0;  ///< of the last count, in units of half the time that counts
    friend bool operator==(const Tile&, const Tile&) = default;
  };
  [[nodiscard]] bool is_proven(const Tile& tile) const;
  /// Far enough in place and time from the tile's last count? Then this becomes the last one.
  [[nodiscard]] bool counts(Tile& tile, const Point2& seen_from, Timestamp time) const;
  /// A tile's place; nothing outside the map.
  [[nodiscard]] std::optional<Cell> tile_of(Cell cell) const;

  GridGeometry geometry_;
  BlockLattice lattice_;
  Tiled<Tile> tiles_;
};

}  // namespace deltamap::localization::belief
