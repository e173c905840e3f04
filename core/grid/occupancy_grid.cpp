// SPDX-License-Identifier: Apache-2.0
#include "core/grid/occupancy_grid.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <limits>
#include <span>

namespace deltamap {
namespace {

constexpr std::uint64_t kPrime = 0x100000001B3u;

/// What a run of equal bytes below 4 makes of a hash: h becomes factor · h + offset[h mod 4]. For h ^ byte differs from
/// h by what the two lowest bits alone decide.
struct Run {
  std::uint64_t factor = 1;
  std::array<std::uint64_t, 4> offset{};

  [[nodiscard]] std::uint64_t after(std::uint64_t hash) const { return factor * hash + offset[hash & 3]; }
  [[nodiscard]] Run then(const Run& next) const {
    Run both{factor * next.factor, {}};
    for (std::uint32_t low = 0; low < 4; ++low) both.offset[low] = next.after(after(low)) - both.factor * low;
    return both;
  }
  static Run of_one(std::uint8_t byte) {
    Run run{kPrime, {}};
    for (std::uint32_t low = 0; low < 4; ++low) run.offset[low] = (std::uint64_t{low ^ byte} - low) * kPrime;
    return run;
  }
  static Run of_eight(std::uint8_t byte) {
    Run run = of_one(byte);
    for (int doubled = 0; doubled < 3; ++doubled) run = run.then(run);
    return run;
  }
};

class Fnv1a {
 public:
  void add(std::uint8_t byte) { hash_ = (hash_ ^ byte) * kPrime; }
  void add_word(std::uint64_t word) {
    for (int shift = 0; shift < 64; shift += 8) add(static_cast<std::uint8_t>(word >> shift));
  }
  void add(std::span<const CellState> cells) {
    static const std::array<Run, 3> kEight{Run::of_eight(0), Run::of_eight(1), Run::of_eight(2)};
    std::size_t next = 0;
    for (; next + 8 <= cells.size(); next += 8) {
      std::uint64_t word = 0;
      std::memcpy(&word, &cells[next], sizeof word);
      if (word == 0x0101010101010101u * (word & 0xFF)) {  // most are as their neighbours
        hash_ = kEight[word & 0xFF].after(hash_);
      } else {
        for (std::size_t i = next; i < next + 8; ++i) add(static_cast<std::uint8_t>(cells[i]));
      }
    }
    for (; next < cells.size(); ++next) add(static_cast<std::uint8_t>(cells[next]));
  }
  /// The same byte, below 4, so many times: in as many steps as the count has binary digits.
  void add_run(std::uint8_t byte, std::size_t count) {
    Run run = Run::of_one(byte);
    for (; count > 0; count >>= 1, run = run.then(run)) {
      if ((count & 1) != 0) hash_ = run.after(hash_);
    }
  }
  [[nodiscard]] std::uint64_t value() const { return hash_; }

 private:
  std::uint64_t hash_ = 0xCBF29CE484222325u;
};

}  // namespace

bool operator==(const OccupancyGrid& a, const OccupancyGrid& b) {
  if (!(a.geometry() == b.geometry())) return false;
  bool same = true;
  const auto differs = [&](Cell cell) { return a.tiles().tile_at(cell) != b.tiles().tile_at(cell); };
  a.tiles().visit_where(a.box(), differs, [&](Cell first, std::span<const CellState> cells) {
    for (int i = 0; same && i < static_cast<int>(cells.size()); ++i)
      same = cells[static_cast<std::size_t>(i)] == b[{first.column + i, first.row}];
  });
  return same;
}

CellBox known_box(const OccupancyGrid& grid) {
  constexpr int kNone = std::numeric_limits<int>::max();
  CellBox box{{kNone, kNone}, {0, 0}};
  for_each_known(grid, [&](Cell cell, CellState) {
    box.first = {std::min(box.first.column, cell.column), std::min(box.first.row, cell.row)};
    box.last = {std::max(box.last.column, cell.column + 1), cell.row + 1};
  });
  return box.empty() ? CellBox{} : box;
}

std::size_t count_of(const OccupancyGrid& grid, CellState state) {
  std::size_t count = 0;
  std::size_t looked_at = 0;
  grid.tiles().visit_written(grid.box(), [&](Cell, std::span<const CellState> cells) {
    count += static_cast<std::size_t>(std::count(cells.begin(), cells.end(), state));
    looked_at += cells.size();
  });
  return grid.fill() == state ? count + grid.geometry().cell_count() - looked_at : count;
}

std::vector<CellState> all_cells(const OccupancyGrid& grid) {
  std::vector<CellState> all(grid.geometry().cell_count(), grid.fill());
  grid.tiles().visit_written(grid.box(), [&](Cell first, std::span<const CellState> cells) {
    std::copy(cells.begin(), cells.end(), all.begin() + static_cast<std::ptrdiff_t>(grid.geometry().index_of(first)));
  });
  return all;
}

std::uint64_t grid_hash(const OccupancyGrid& grid) {
  Fnv1a hash;
  hash.add_word(static_cast<std::uint64_t>(grid.width()));
  hash.add_word(static_cast<std::uint64_t>(grid.height()));
  for (const double value : {grid.resolution_m(), grid.geometry().origin.x(), grid.geometry().origin.y()}) {
    hash.add_word(std::bit_cast<std::uint64_t>(value));
  }
  const auto fill = static_cast<std::uint8_t>(grid.fill());
  std::size_t next = 0;
  grid.tiles().visit_written(grid.box(), [&](Cell first, std::span<const CellState> cells) {
    const std::size_t index = grid.geometry().index_of(first);
    if (index > next) hash.add_run(fill, index - next);
    hash.add(cells);
    next = index + cells.size();
  });
  hash.add_run(fill, grid.geometry().cell_count() - next);
  return hash.value();
}

}  // namespace deltamap
