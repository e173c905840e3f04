// SPDX-License-Identifier: Apache-2.0
#include "daemon/steps/ignored_ground.hpp"

#include <algorithm>
#include <utility>

#include "localization/localizer.hpp"

namespace deltamap::daemon {

IgnoredGround::IgnoredGround(const Zones& zones, std::shared_ptr<const OccupancyGrid> map)
    : ground_{zones, {ZoneKind::kIgnore}}, whole_{std::move(map)}, known_{without_ignored()} {}

std::shared_ptr<const OccupancyGrid> IgnoredGround::without_ignored() const {
  if (ground_.empty()) return whole_;
  const GridGeometry& geometry = whole_->geometry();
  std::vector<CellChange> changes;
  for (const PolygonBox& box : ground_.boxes()) {
    const Cell low = geometry.cell_at(box.low);
    const Cell high = geometry.cell_at(box.high);
    for (int row = std::max(0, low.row); row <= std::min(geometry.height - 1, high.row); ++row) {
      for (int column = std::max(0, low.column); column <= std::min(geometry.width - 1, high.column); ++column) {
        const Cell cell{column, row};
        const CellState state = (*whole_)[cell];
        if (state != CellState::kUnknown && ground_.covers(geometry.centre_of(cell)))
          changes.push_back({cell, state, CellState::kUnknown});
      }
    }
  }
  return std::make_shared<const OccupancyGrid>(patched(*whole_, changes));
}

MapRevision IgnoredGround::follow(const MapRevision& revision, const localization::LocalizerParams& params) {
  const bool has_grown = revision.map->geometry() != whole_->geometry();
  whole_ = revision.map;
  if (ground_.empty() || has_grown || revision.changes.empty()) {
    known_ = without_ignored();
    MapRevision same = revision;
    same.map = known_;
    if (!ground_.empty()) same.field_patch = {};
    return same;
  }
  MapRevision known{
      .number = revision.number, .time = revision.time, .map = {}, .changes = revision.changes, .field_patch = {}};
  const GridGeometry& geometry = whole_->geometry();
  std::erase_if(known.changes,
                [&](const CellChange& change) { return ground_.covers(geometry.centre_of(change.cell)); });
  known_ = std::make_shared<const OccupancyGrid>(patched(*known_, known.changes));
  known.map = known_;
  known.field_patch = localization::prepared_field_patch(params, *known_, known.changes);
  return known;
}

bool IgnoredGround::set_zones(const Zones& zones) {
  const bool was_whole = ground_.empty();
  ground_ = ZonedGround{zones, {ZoneKind::kIgnore}};
  if (was_whole && ground_.empty()) return false;
  known_ = without_ignored();
  return true;
}

}  // namespace deltamap::daemon
