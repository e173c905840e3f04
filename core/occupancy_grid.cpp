// SPDX-License-Identifier: Apache-2.0
#include "core/occupancy_grid.hpp"

#include <algorithm>
#include <bit>

namespace deltamap {
namespace {

class Fnv1a {
 public:
  void add(std::uint8_t byte) { hash_ = (hash_ ^ byte) * 0x100000001B3u; }
  void add_word(std::uint64_t word) {
    for (int shift = 0; shift < 64; shift += 8) add(static_cast<std::uint8_t>(word >> shift));
  }
  [[nodiscard]] std::uint64_t value() const { return hash_; }

 private:
  std::uint64_t hash_ = 0xCBF29CE484222325u;
};

}  // namespace

std::size_t count_of(const OccupancyGrid& grid, CellState state) {
  return static_cast<std::size_t>(std::count(grid.cells().begin(), grid.cells().end(), state));
}

std::uint64_t grid_hash(const OccupancyGrid& grid) {
  Fnv1a hash;
  hash.add_word(static_cast<std::uint64_t>(grid.width()));
  hash.add_word(static_cast<std::uint64_t>(grid.height()));
  for (const double value : {grid.resolution_m(), grid.geometry().origin.x(), grid.geometry().origin.y()}) {
    hash.add_word(std::bit_cast<std::uint64_t>(value));
  }
  for (const CellState cell : grid.cells()) hash.add(static_cast<std::uint8_t>(cell));
  return hash.value();
}

}  // namespace deltamap
