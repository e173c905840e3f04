// SPDX-License-Identifier: Apache-2.0
#include "localization/belief/stability.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

namespace deltamap::localization::belief {
namespace {

constexpr double kTileM = 0.2;
constexpr double kApartS = 20.0;              // a confirmation counts only so long after the last one,
constexpr double kApartM = 1.0;               // and from so far away from where that was made
constexpr int kProvenAfter = 6;               // counted confirmations: with kApartS two minutes at least
constexpr int kMostLevel = 4 * kProvenAfter;  // three counted refutations undo the longest history
constexpr int kLeastUnitsApart = 3;           // of half a distance or time: surely more than one whole

/// 16 units of half kApartM in x and y; farther places may look alike, which only delays a count.
std::uint8_t place_of(const Point2& seen_from) {
  const auto nibble = [&](double along_m) {
    return static_cast<unsigned>(static_cast<std::int64_t>(std::floor(2.0 * along_m / kApartM)) & 15);
  };
  return static_cast<std::uint8_t>(nibble(seen_from.x()) << 4U | nibble(seen_from.y()));
}

int units_apart(unsigned a, unsigned b, unsigned cycle) {
  const unsigned ahead = (a - b) & (cycle - 1);
  return static_cast<int>(std::min(ahead, cycle - ahead));
}

std::uint8_t moment_of(Timestamp time) {
  constexpr auto kHalfNs = static_cast<std::int64_t>(0.5e9 * kApartS);
  return static_cast<std::uint8_t>((time.time_since_epoch().count() / kHalfNs) & 255);
}

std::uint8_t direction_bit(const Point2& from, const Point2& to) {
  const double turns = std::atan2(to.y() - from.y(), to.x() - from.x()) / (2.0 * std::numbers::pi) + 0.5;
  return static_cast<std::uint8_t>(1U << std::min(7U, static_cast<unsigned>(8.0 * turns)));
}

}  // namespace

Stability::Stability(const GridGeometry& geometry)
    : geometry_{geometry},
      lattice_{geometry, std::max(1, static_cast<int>(std::lround(kTileM / geometry.resolution_m)))},
      tiles_{lattice_.blocks().width, lattice_.blocks().height, Tile{}} {}

std::optional<Cell> Stability::tile_of(Cell cell) const {
  return geometry_.contains(cell) ? std::optional{lattice_.block_of(cell)} : std::nullopt;
}

bool Stability::counts(Tile& tile, const Point2& seen_from, Timestamp time) const {
  const std::uint8_t place = place_of(seen_from);
  const std::uint8_t moment = moment_of(time);
  const bool first = tile.directions == 0;
  const bool elsewhere = units_apart(place >> 4U, tile.place >> 4U, 16) >= kLeastUnitsApart ||
                         units_apart(place & 15U, tile.place & 15U, 16) >= kLeastUnitsApart;
  if (!first && !(elsewhere && units_apart(moment, tile.moment, 256) >= kLeastUnitsApart)) return false;
  tile.place = place;
  tile.moment = moment;
  return true;
}

void Stability::confirm(Cell cell, const Point2& seen_from, Timestamp time) {
  const std::optional<Cell> place = tile_of(cell);
  if (!place) return;
  Tile tile = tiles_[*place];
  if (!counts(tile, seen_from, time)) return;
  tile.level = static_cast<std::uint8_t>(std::min(kMostLevel, tile.level + 1));
  tile.directions = static_cast<std::uint8_t>(tile.directions | direction_bit(geometry_.centre_of(cell), seen_from));
  tiles_.set(*place, tile);
}

void Stability::refute(Cell cell, const Point2& seen_from, Timestamp time) {
  const std::optional<Cell> place = tile_of(cell);
  if (!place) return;
  Tile tile = tiles_[*place];
  if (tile.level == 0 || !counts(tile, seen_from, time)) return;
  tile.level /= 2;
  if (tile.level == 0) tile.directions = 0;
  tiles_.set(*place, tile);
}

void Stability::forget(std::span<const CellChange> changes) {
  for (const CellChange& change : changes) {
    const bool obstacle = change.before == CellState::kOccupied || change.after == CellState::kOccupied;
    const std::optional<Cell> place = tile_of(change.cell);
    if (obstacle && place) tiles_.set(*place, Tile{});
  }
}

bool Stability::is_proven(const Tile& tile) const {
  return tile.level >= kProvenAfter && std::popcount(tile.directions) >= 2;
}

bool Stability::proven(Cell cell) const {
  const std::optional<Cell> place = tile_of(cell);
  return place && is_proven(tiles_[*place]);
}

std::size_t Stability::proven_tiles() const {
  std::size_t count = 0;
  tiles_.visit_written(lattice_.blocks().box(), [&](Cell, std::span<const Tile> tiles) {
    count += static_cast<std::size_t>(
        std::count_if(tiles.begin(), tiles.end(), [&](const Tile& tile) { return is_proven(tile); }));
  });
  return count;
}

StabilityRecord Stability::record() const {
  const GridGeometry& places = lattice_.blocks();
  StabilityRecord record{geometry_, lattice_.cells_per_block(), {}};
  record.bytes.resize(StabilityRecord::kBytesATile * places.cell_count());
  tiles_.visit_written(places.box(), [&](Cell first, std::span<const Tile> tiles) {
    std::uint8_t* to = record.bytes.data() + StabilityRecord::kBytesATile * places.index_of(first);
    for (const Tile& tile : tiles) {
      for (const std::uint8_t byte : {tile.level, tile.directions, tile.place, tile.moment}) *to++ = byte;
    }
  });
  return record;
}

bool Stability::restore(const StabilityRecord& record) {
  const GridGeometry& places = lattice_.blocks();
  if (!(record.geometry == geometry_) || record.cells_a_tile != lattice_.cells_per_block() ||
      record.bytes.size() != StabilityRecord::kBytesATile * places.cell_count()) {
    return false;
  }
  for (std::size_t i = 0; i < places.cell_count(); ++i) {
    const std::uint8_t* const kept = record.bytes.data() + StabilityRecord::kBytesATile * i;
    tiles_.set(places.cell_of(i),
               {static_cast<std::uint8_t>(std::min<int>(kMostLevel, kept[0])), kept[1], kept[2], kept[3]});
  }
  return true;
}

}  // namespace deltamap::localization::belief
