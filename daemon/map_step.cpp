// SPDX-License-Identifier: Apache-2.0
#include "daemon/map_step.hpp"

#include <algorithm>

namespace deltamap::daemon {
namespace {

ChangeNote note_of(const ScanSet& set, const mapping::MapUpdate& update, const GridGeometry& geometry) {
  ChangeNote note;
  note.time = set.ended;
  note.phase = set.phase;
  note.scans = static_cast<std::uint32_t>(set.scans.size());
  note.acceptance = update.acceptance;
  note.covariance = set.covariance;
  if (!update.accepted()) {
    note.reason = mapping::name_of(update.refusal);
    return note;
  }
  const auto count = [&](CellState state) {
    return static_cast<std::uint32_t>(std::count_if(update.changes.begin(), update.changes.end(),
                                                    [&](const CellChange& change) { return change.after == state; }));
  };
  note.added = count(CellState::kOccupied);
  note.freed = count(CellState::kFree);
  note.forgotten = count(CellState::kUnknown);
  const CellBox box = bounding_box(update.changes);
  note.box_low = geometry.origin + geometry.resolution_m * Point2{box.first.column, box.first.row};
  note.box_high = geometry.origin + geometry.resolution_m * Point2{box.last.column, box.last.row};
  return note;
}

}  // namespace

MapStep::MapStep(const Settings& settings, StartMap start)
    : method_{settings.mapping.store_scan.method == MappingMethod::kPaper ? "paper" : "evidence"},
      update_{settings.mapping.update},
      localizer_{settings.localizer},
      newest_{std::move(start)} {}

MapStep::Result MapStep::update(const ScanSet& set) {
  mapping::MapUpdate update = mapping::map_update(*newest_.map, set, update_);
  Result result{.revision = std::nullopt, .note = note_of(set, update, newest_.map->geometry())};
  if (!update.accepted()) return result;
  newest_.map = std::make_shared<const OccupancyGrid>(patched(*newest_.map, update.changes));
  ++newest_.revision;
  result.note.revision = newest_.revision;
  result.revision = MapRevision{.number = newest_.revision,
                                .time = set.ended,
                                .map = newest_.map,
                                .changes = std::move(update.changes),
                                .field_patch = {}};
  result.revision->field_patch = localization::prepared_field_patch(localizer_, *newest_.map, result.revision->changes);
  return result;
}

}  // namespace deltamap::daemon
