// SPDX-License-Identifier: Apache-2.0
#include "localization/stability.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

namespace deltamap::localization {
namespace {

constexpr int kMostLevels = 4;       // of proven_after: three counted refutations undo the longest history
constexpr int kLeastUnitsApart = 3;  // of half a distance or time: surely more than one whole
constexpr std::size_t kBytesATile = 4;

int tiles_along(int cells, int cells_a_tile) { return (cells + cells_a_tile - 1) / cells_a_tile; }

/// 16 units of half `apart_m` in x and y; farther places may look alike, which only delays a count.
std::uint8_t place_of(const Point2& seen_from, double apart_m) {
  const auto nibble = [&](double along_m) {
    return static_cast<unsigned>(static_cast<std::int64_t>(std::floor(2.0 * along_m / apart_m)) & 15);
  };
  return static_cast<std::uint8_t>(nibble(seen_from.x()) << 4U | nibble(seen_from.y()));
}

int units_apart(unsigned a, unsigned b, unsigned cycle) {
  const unsigned ahead = (a - b) & (cycle - 1);
  return static_cast<int>(std::min(ahead, cycle - ahead));
}

std::uint8_t moment_of(Timestamp time, double apart_s) {
  const auto half_ns = static_cast<std::int64_t>(0.5e9 * apart_s);
  return static_cast<std::uint8_t>((time.time_since_epoch().count() / std::max<std::int64_t>(1, half_ns)) & 255);
}

std::uint8_t direction_bit(const Point2& from, const Point2& to) {
  const double turns = std::atan2(to.y() - from.y(), to.x() - from.x()) / (2.0 * std::numbers::pi) + 0.5;
  return static_cast<std::uint8_t>(1U << std::min(7U, static_cast<unsigned>(8.0 * turns)));
}

}  // namespace

Stability::Stability(const GridGeometry& geometry, const StabilityParams& params)
    : geometry_{geometry},
      params_{params},
      cells_a_tile_{std::max(1, static_cast<int>(std::lround(params.tile_m / geometry.resolution_m)))},
      columns_{tiles_along(geometry.width, cells_a_tile_)},
      tiles_(static_cast<std::size_t>(columns_) *
             static_cast<std::size_t>(tiles_along(geometry.height, cells_a_tile_))) {}

Stability::Tile* Stability::tile_at(Cell cell) {
  if (!geometry_.contains(cell)) return nullptr;
  return &tiles_[static_cast<std::size_t>(cell.row / cells_a_tile_) * static_cast<std::size_t>(columns_) +
                 static_cast<std::size_t>(cell.column / cells_a_tile_)];
}

bool Stability::counts(Tile& tile, const Point2& seen_from, Timestamp time) const {
  const std::uint8_t place = place_of(seen_from, params_.apart_m);
  const std::uint8_t moment = moment_of(time, params_.apart_s);
  const bool first = tile.directions == 0;
  const bool elsewhere = units_apart(place >> 4U, tile.place >> 4U, 16) >= kLeastUnitsApart ||
                         units_apart(place & 15U, tile.place & 15U, 16) >= kLeastUnitsApart;
  if (!first && !(elsewhere && units_apart(moment, tile.moment, 256) >= kLeastUnitsApart)) return false;
  tile.place = place;
  tile.moment = moment;
  return true;
}

void Stability::confirm(Cell cell, const Point2& seen_from, Timestamp time) {
  Tile* const tile = tile_at(cell);
  if (tile == nullptr || !counts(*tile, seen_from, time)) return;
  tile->level = static_cast<std::uint8_t>(std::min(kMostLevels * params_.proven_after, tile->level + 1));
  tile->directions = static_cast<std::uint8_t>(tile->directions | direction_bit(geometry_.centre_of(cell), seen_from));
}

void Stability::refute(Cell cell, const Point2& seen_from, Timestamp time) {
  Tile* const tile = tile_at(cell);
  if (tile == nullptr || tile->level == 0 || !counts(*tile, seen_from, time)) return;
  tile->level /= 2;
  if (tile->level == 0) tile->directions = 0;
}

void Stability::forget(std::span<const CellChange> changes) {
  for (const CellChange& change : changes) {
    const bool obstacle = change.before == CellState::kOccupied || change.after == CellState::kOccupied;
    if (Tile* const tile = tile_at(change.cell); obstacle && tile != nullptr) *tile = Tile{};
  }
}

bool Stability::is_proven(const Tile& tile) const {
  return tile.level >= params_.proven_after && std::popcount(tile.directions) >= 2;
}

bool Stability::proven(Cell cell) const {
  const Tile* const tile = tile_at(cell);
  return tile != nullptr && is_proven(*tile);
}

std::size_t Stability::proven_tiles() const {
  return static_cast<std::size_t>(
      std::count_if(tiles_.begin(), tiles_.end(), [&](const Tile& tile) { return is_proven(tile); }));
}

StabilityRecord Stability::record() const {
  StabilityRecord record{geometry_, cells_a_tile_, {}};
  record.bytes.reserve(kBytesATile * tiles_.size());
  for (const Tile& tile : tiles_) {
    record.bytes.insert(record.bytes.end(), {tile.level, tile.directions, tile.place, tile.moment});
  }
  return record;
}

bool Stability::restore(const StabilityRecord& record) {
  if (!(record.geometry == geometry_) || record.cells_a_tile != cells_a_tile_ ||
      record.bytes.size() != kBytesATile * tiles_.size()) {
    return false;
  }
  const int most = kMostLevels * params_.proven_after;
  for (std::size_t i = 0; i < tiles_.size(); ++i) {
    const std::uint8_t* const kept = record.bytes.data() + kBytesATile * i;
    tiles_[i] = {static_cast<std::uint8_t>(std::min<int>(most, kept[0])), kept[1], kept[2], kept[3]};
  }
  return true;
}

}  // namespace deltamap::localization
