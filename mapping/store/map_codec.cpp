// SPDX-License-Identifier: Apache-2.0
#include "mapping/store/map_codec.hpp"

#include <algorithm>
#include <utility>

namespace deltamap::mapping::store {
namespace {

void put(std::vector<std::uint8_t>& bytes, std::uint64_t number) {
  for (; number >= 0x80; number >>= 7) bytes.push_back(static_cast<std::uint8_t>(number | 0x80));
  bytes.push_back(static_cast<std::uint8_t>(number));
}

void put_run(std::vector<std::uint8_t>& bytes, std::size_t cells, CellState state) {
  put(bytes, std::uint64_t{cells} << 2 | static_cast<std::uint64_t>(state));
}

class Reader {
 public:
  explicit Reader(std::span<const std::uint8_t> bytes) : bytes_{bytes} {}
  [[nodiscard]] bool at_end() const { return bytes_.empty(); }

  /// Nothing where the bytes end in the middle.
  std::optional<std::uint64_t> take() {
    std::uint64_t number = 0;
    for (std::size_t i = 0; i < bytes_.size() && i < 9; ++i) {
      number |= static_cast<std::uint64_t>(bytes_[i] & 0x7F) << (7 * i);
      if (bytes_[i] < 0x80) {
        bytes_ = bytes_.subspan(i + 1);
        return number;
      }
    }
    return std::nullopt;
  }

 private:
  std::span<const std::uint8_t> bytes_;
};

constexpr bool is_state(std::uint64_t number) { return number <= static_cast<std::uint64_t>(CellState::kUnknown); }

}  // namespace

std::vector<std::uint8_t> encoded_grid(const OccupancyGrid& grid) {
  std::vector<std::uint8_t> bytes;
  CellState state = grid.fill();
  std::size_t count = 0;  // cells of the run so far
  const auto add = [&](CellState next, std::size_t cells) {
    if (cells == 0) return;
    if (next != state && count > 0) put_run(bytes, std::exchange(count, 0), state);
    state = next;
    count += cells;
  };
  std::size_t next = 0;
  grid.tiles().visit_written(grid.box(), [&](Cell first, std::span<const CellState> cells) {
    const std::size_t index = grid.geometry().index_of(first);
    add(grid.fill(), index - next);
    for (const CellState cell : cells) add(cell, 1);
    next = index + cells.size();
  });
  add(grid.fill(), grid.geometry().cell_count() - next);
  if (count > 0) put_run(bytes, count, state);
  return bytes;
}

std::optional<OccupancyGrid> decoded_grid(std::span<const std::uint8_t> bytes, const GridGeometry& geometry) {
  OccupancyGrid grid{geometry};
  std::size_t next = 0;
  Reader reader{bytes};
  while (!reader.at_end()) {
    const auto run = reader.take();
    if (!run || !is_state(*run & 3) || *run >> 2 > geometry.cell_count() - next) return std::nullopt;
    const auto state = static_cast<CellState>(*run & 3);
    const std::size_t end = next + static_cast<std::size_t>(*run >> 2);
    if (state != CellState::kUnknown) {
      for (std::size_t index = next; index < end; ++index) grid.set(geometry.cell_of(index), state);
    }
    next = end;
  }
  if (next != geometry.cell_count()) return std::nullopt;
  return grid;
}

std::vector<std::uint8_t> encoded_changes(std::span<const CellChange> changes, const GridGeometry& geometry) {
  std::vector<CellChange> sorted{changes.begin(), changes.end()};
  std::sort(sorted.begin(), sorted.end(), [&](const CellChange& a, const CellChange& b) {
    return geometry.index_of(a.cell) < geometry.index_of(b.cell);
  });
  std::vector<std::uint8_t> bytes;
  std::size_t after_last = 0;
  for (auto run = sorted.begin(); run != sorted.end();) {
    auto end = run + 1;
    while (end != sorted.end() && end->before == run->before && end->after == run->after &&
           geometry.index_of(end->cell) == geometry.index_of((end - 1)->cell) + 1) {
      ++end;
    }
    const std::size_t first = geometry.index_of(run->cell);
    put(bytes, first - after_last);
    put(bytes, static_cast<std::uint64_t>(end - run) << 4 | static_cast<std::uint64_t>(run->before) << 2 |
                   static_cast<std::uint64_t>(run->after));
    after_last = first + static_cast<std::size_t>(end - run);
    run = end;
  }
  return bytes;
}

std::optional<std::vector<CellChange>> decoded_changes(std::span<const std::uint8_t> bytes,
                                                       const GridGeometry& geometry) {
  std::vector<CellChange> changes;
  std::size_t next = 0;
  Reader reader{bytes};
  while (!reader.at_end()) {
    const auto gap = reader.take();
    const auto run = reader.take();
    if (!gap || !run || !is_state(*run >> 2 & 3) || !is_state(*run & 3)) return std::nullopt;
    if (*gap > geometry.cell_count() - next || *run >> 4 > geometry.cell_count() - next - *gap) return std::nullopt;
    next += static_cast<std::size_t>(*gap);
    for (std::uint64_t left = *run >> 4; left > 0; --left) {
      changes.push_back(
          {geometry.cell_of(next++), static_cast<CellState>(*run >> 2 & 3), static_cast<CellState>(*run & 3)});
    }
  }
  return changes;
}

}  // namespace deltamap::mapping::store
