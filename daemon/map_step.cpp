// SPDX-License-Identifier: Apache-2.0
#include "daemon/map_step.hpp"

#include <algorithm>
#include <span>

#include "mapping/taken_back.hpp"

namespace deltamap::daemon {
namespace {

constexpr std::size_t kMostProvisional = 256;  // of a robot that stands for hours: older ones count as settled

ChangeNote note_of(const ScanSet& set, std::span<const CellChange> changes, const GridGeometry& geometry) {
  ChangeNote note;
  note.time = set.ended;
  note.phase = set.phase;
  note.scans = static_cast<std::uint32_t>(set.scans.size());
  note.covariance = set.covariance;
  if (changes.empty()) return note;
  const auto count = [&](CellState state) {
    return static_cast<std::uint32_t>(
        std::count_if(changes.begin(), changes.end(), [&](const CellChange& change) { return change.after == state; }));
  };
  note.added = count(CellState::kOccupied);
  note.freed = count(CellState::kFree);
  note.forgotten = count(CellState::kUnknown);
  const CellBox box = bounding_box(changes);
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

MapRevision MapStep::publish(Timestamp time, std::vector<CellChange> changes) {
  newest_.map = std::make_shared<const OccupancyGrid>(patched(*newest_.map, changes));
  ++newest_.revision;
  MapRevision revision{
      .number = newest_.revision, .time = time, .map = newest_.map, .changes = std::move(changes), .field_patch = {}};
  revision.field_patch = localization::prepared_field_patch(localizer_, *newest_.map, revision.changes);
  return revision;
}

void MapStep::settle(const std::optional<Timestamp>& before) {
  while (!provisional_.empty() &&
         (provisional_.size() > kMostProvisional || (before && provisional_.front().time < *before))) {
    provisional_.pop_front();
  }
}

MapStep::Result MapStep::update(const ScanSet& set) {
  if (set.withdraw_from) return withdraw(set);
  settle(set.settled);
  mapping::MapUpdate update = mapping::map_update(*newest_.map, set, update_);
  Result result{.revision = std::nullopt, .note = note_of(set, update.changes, newest_.map->geometry())};
  result.note.acceptance = update.acceptance;
  if (!update.accepted()) {
    result.note.reason = mapping::name_of(update.refusal);
    return result;
  }
  result.revision = publish(set.ended, std::move(update.changes));
  result.note.revision = result.revision->number;
  provisional_.push_back({result.revision->number, set.ended, result.revision->changes});
  return result;
}

MapStep::Result MapStep::withdraw(const ScanSet& order) {
  OccupancyGrid map = *newest_.map;
  std::vector<std::uint32_t> withdrawn;
  while (!provisional_.empty() && provisional_.back().time >= *order.withdraw_from) {
    const std::vector<CellChange> back = mapping::taken_back(map, provisional_.back().changes);
    map = patched(std::move(map), back);
    withdrawn.push_back(provisional_.back().number);
    provisional_.pop_back();
  }
  std::vector<CellChange> changes = changes_between(*newest_.map, map);
  Result result{.revision = std::nullopt, .note = note_of(order, changes, map.geometry())};
  result.note.reason = changes.empty() ? "nothing to withdraw" : "withdrawn";
  if (changes.empty()) return result;
  std::reverse(withdrawn.begin(), withdrawn.end());
  result.note.withdraws = std::move(withdrawn);
  result.revision = publish(order.ended, std::move(changes));
  result.note.revision = result.revision->number;
  return result;
}

}  // namespace deltamap::daemon
