// SPDX-License-Identifier: Apache-2.0
// A value for each cell of a grid, in square tiles. A tile in which every cell has the background's value need not
// exist, and copies share their tiles until one of them is written to: what is stored grows with what has been written,
// not with the grid. Copies may live in different threads, as those of a std::shared_ptr may.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "core/grid/grid_geometry.hpp"

namespace deltamap {

template <typename T>
class Tiled {
 public:
  static constexpr int kSide = 64;  ///< cells of a tile in a row, and rows

  Tiled() = default;
  Tiled(int width, int height, const T& background)
      : across_{tiles_along(width)}, background_{std::make_shared<Tile>()} {
    background_->values.fill(background);
    tiles_.assign(across_ * tiles_along(height), background_.get());
  }
  Tiled(const Tiled& other) : across_{other.across_}, background_{other.background_}, tiles_{other.tiles_} {
    for (Tile* const tile : tiles_) {
      if (tile != background_.get()) tile->owners.fetch_add(1, std::memory_order_relaxed);
    }
  }
  Tiled(Tiled&& other) noexcept { swap(other); }
  Tiled& operator=(Tiled other) noexcept {
    swap(other);
    return *this;
  }
  ~Tiled() {
    for (Tile* const tile : tiles_) {
      if (tile != background_.get()) leave(tile);
    }
  }

  /// The cell must lie in the grid.
  [[nodiscard]] const T& operator[](Cell cell) const { return tiles_[place_of(cell)]->values[slot_of(cell)]; }
  /// The same value, to be written: the tile exists from now on, and is no other copy's.
  [[nodiscard]] T& to_write(Cell cell) {
    Tile*& tile = tiles_[place_of(cell)];
    if (tile == background_.get() || tile->owners.load(std::memory_order_acquire) > 1) tile = own_copy(tile);
    return tile->values[slot_of(cell)];
  }
  /// Writes only where that changes something.
  void set(Cell cell, const T& value) {
    if ((*this)[cell] != value) to_write(cell) = value;
  }

  /// The values of the cell's tile, kSide in a row. Two copies that share a tile answer the same address.
  [[nodiscard]] const T* tile_at(Cell cell) const { return tiles_[place_of(cell)]->values.data(); }
  /// The tile of all cells in whose tiles nothing has been written.
  [[nodiscard]] const T* background() const { return background_->values.data(); }
  /// Where in its tile a cell lies.
  [[nodiscard]] static std::size_t slot_of(Cell cell) {
    const unsigned row = static_cast<unsigned>(cell.row) % kSide;
    const unsigned column = static_cast<unsigned>(cell.column) % kSide;
    return row * kSide + column;
  }

  /// `visit(Cell, const T&)` for the cells at most `reach` columns and rows from one, row by row, as far as they lie in
  /// the grid. Within a tile that costs little more than reading them.
  template <typename Visit>
  void visit_around(Cell middle, int reach, const GridGeometry& grid, Visit&& visit) const;
  /// The cells of a box, which lies in the grid, in tiles that are wanted: row by row, in pieces of a row,
  /// `visit(Cell first, std::span<const T> values)`. `is_wanted(Cell)` is asked once a tile, with one of its cells.
  template <typename IsWanted, typename Visit>
  void visit_where(const CellBox& box, IsWanted&& is_wanted, Visit&& visit) const;
  /// In tiles that have been written to: all other cells have the background's value.
  template <typename Visit>
  void visit_written(const CellBox& box, Visit&& visit) const {
    visit_where(
        box, [&](Cell cell) { return tile_at(cell) != background(); }, visit);
  }
  [[nodiscard]] std::size_t tiles_written() const {
    return static_cast<std::size_t>(
        std::count_if(tiles_.begin(), tiles_.end(), [&](const Tile* tile) { return tile != background_.get(); }));
  }

  /// Of two grids of one size and background.
  friend bool operator==(const Tiled& a, const Tiled& b) {
    return std::equal(a.tiles_.begin(), a.tiles_.end(), b.tiles_.begin(), b.tiles_.end(),
                      [](const Tile* one, const Tile* other) { return one == other || one->values == other->values; });
  }

 private:
  struct Tile {
    std::array<T, static_cast<std::size_t>(kSide) * kSide> values;
    std::atomic<std::uint32_t> owners{1};
  };

  [[nodiscard]] static std::size_t tiles_along(int cells) {
    return static_cast<std::size_t>((cells + kSide - 1) / kSide);
  }
  [[nodiscard]] std::size_t place_of(Cell cell) const {
    assert(cell.column >= 0 && cell.row >= 0 && "the cell must lie in the grid");
    return static_cast<unsigned>(cell.row) / kSide * across_ + static_cast<unsigned>(cell.column) / kSide;
  }
  /// The first cell of the next tile, or the last of all.
  [[nodiscard]] static int next_tile(int cell, int last) { return std::min(last, (cell / kSide + 1) * kSide); }
  /// Another copy that leaves its tile at the same time finds itself the last one, and clears up.
  [[nodiscard]] Tile* own_copy(Tile* tile) {
    auto copy = std::make_unique<Tile>();
    copy->values = tile->values;
    if (tile != background_.get()) leave(tile);
    return copy.release();
  }
  static void leave(Tile* tile) {
    if (tile->owners.fetch_sub(1, std::memory_order_acq_rel) == 1) delete tile;
  }
  void swap(Tiled& other) noexcept {
    std::swap(across_, other.across_);
    std::swap(background_, other.background_);
    std::swap(tiles_, other.tiles_);
  }

  std::size_t across_ = 0;
  std::shared_ptr<Tile> background_;
  std::vector<Tile*> tiles_;  // row by row; those that do not exist: the background
};

template <typename T>
template <typename Visit>
void Tiled<T>::visit_around(Cell middle, int reach, const GridGeometry& grid, Visit&& visit) const {
  const auto is_inside = [&](int cell, int cells) {
    const int in_tile = static_cast<int>(static_cast<unsigned>(cell) % kSide);
    return in_tile >= reach && in_tile + reach < kSide && cell + reach < cells;
  };
  if (grid.contains(middle) && is_inside(middle.column, grid.width) && is_inside(middle.row, grid.height)) {
    const T* values = &(*this)[{middle.column, middle.row - reach}];
    for (int row = -reach; row <= reach; ++row, values += kSide) {
      for (int column = -reach; column <= reach; ++column)
        visit(Cell{middle.column + column, middle.row + row}, values[column]);
    }
    return;
  }
  for (int row = middle.row - reach; row <= middle.row + reach; ++row) {
    for (int column = middle.column - reach; column <= middle.column + reach; ++column) {
      if (grid.contains({column, row})) visit(Cell{column, row}, (*this)[{column, row}]);
    }
  }
}

template <typename T>
template <typename IsWanted, typename Visit>
void Tiled<T>::visit_where(const CellBox& box, IsWanted&& is_wanted, Visit&& visit) const {
  std::vector<int> columns;  // where pieces begin, in this row of tiles
  for (int band = box.first.row; band < box.last.row; band = next_tile(band, box.last.row)) {
    columns.clear();
    for (int column = box.first.column; column < box.last.column; column = next_tile(column, box.last.column)) {
      if (is_wanted(Cell{column, band})) columns.push_back(column);
    }
    if (columns.empty()) continue;
    for (int row = band; row < next_tile(band, box.last.row); ++row) {
      for (const int column : columns) {
        const int count = next_tile(column, box.last.column) - column;
        visit(Cell{column, row}, std::span<const T>{&(*this)[{column, row}], static_cast<std::size_t>(count)});
      }
    }
  }
}

}  // namespace deltamap
