// SPDX-License-Identifier: Apache-2.0
#include "localization/surfaces/surface_map.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace deltamap::localization::surfaces {
namespace {

constexpr int kReachCells = 5;    // how far a changed cell changes what counts as a surface
constexpr double kAlikeM = 0.03;  // across
constexpr double kAlikeAlongM = 0.3;
constexpr double kAlikeCosine = 0.9994;  // 2°

/// The same piece of a line, give or take what a redrawn map moves it by.
bool lies_alike(const Surface& a, const Surface& b) {
  return a.normal.dot(b.normal) >= kAlikeCosine && std::abs(a.normal.dot(b.centre - a.centre)) <= kAlikeM &&
         std::abs(a.tangent().dot(b.centre - a.centre)) <= kAlikeAlongM &&
         std::abs(a.half_length_m - b.half_length_m) <= kAlikeAlongM;
}

}  // namespace

SurfaceMap::SurfaceMap(std::shared_ptr<const OccupancyGrid> map)
    : map_{std::move(map)},
      lattice_{map_->geometry(),
               std::max(8, static_cast<int>(std::lround(sensor::kMovesAsOneM / map_->resolution_m())))} {}

bool SurfaceMap::apply(std::shared_ptr<const OccupancyGrid> map, const CellBox& changed) {
  if (!(map->geometry() == map_->geometry())) {
    *this = SurfaceMap{std::move(map)};
    return false;
  }
  map_ = std::move(map);
  if (changed.empty()) return true;
  const CellBox tiles = lattice_.blocks_of(grown(changed, kReachCells, map_->geometry()));
  for (int row = tiles.first.row; row < tiles.last.row; ++row) {
    for (int column = tiles.first.column; column < tiles.last.column; ++column) {
      const auto known = tiles_.find(static_cast<std::int32_t>(lattice_.blocks().index_of({column, row})));
      if (known == tiles_.end()) continue;
      std::vector<SurfaceRecord> anew = found_in(known->first);
      for (SurfaceRecord& record : anew) {
        const auto same = std::find_if(known->second.begin(), known->second.end(), [&](const SurfaceRecord& old) {
          return lies_alike(old.surface, record.surface);
        });
        if (same == known->second.end()) continue;
        record = *same;
        record.followed_as = SurfaceRecord::kNotFollowed;
      }
      known->second = std::move(anew);
    }
  }
  return true;
}

SurfaceMap::Id SurfaceMap::like(const Surface& surface) {
  Id best;
  near(surface.centre, 0.0, [&](Id id, const SurfaceRecord& record) {
    if (!best.is_valid() && lies_alike(record.surface, surface)) best = id;
  });
  return best;
}

const std::vector<SurfaceRecord>& SurfaceMap::records_of(std::int32_t tile) {
  const auto known = tiles_.find(tile);
  return known != tiles_.end() ? known->second : tiles_.emplace(tile, found_in(tile)).first->second;
}

std::vector<SurfaceRecord> SurfaceMap::found_in(std::int32_t tile) const {
  const Cell place = lattice_.blocks().cell_of(static_cast<std::size_t>(tile));
  const CellBox box = common(lattice_.cells_of(place), map_->box());
  std::vector<SurfaceRecord> records;
  for (const Surface& surface : surfaces_in(*map_, box)) records.push_back({.surface = surface});
  return records;
}

CellBox SurfaceMap::tiles_around(const Point2& at, double reach_m) const {
  const Cell low = lattice_.blocks().cell_at(at - Point2::Constant(reach_m));
  const Cell high = lattice_.blocks().cell_at(at + Point2::Constant(reach_m));
  return common({low, {high.column + 1, high.row + 1}}, lattice_.blocks().box());
}

}  // namespace deltamap::localization::surfaces
