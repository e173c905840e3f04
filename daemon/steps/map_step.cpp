// SPDX-License-Identifier: Apache-2.0
#include "daemon/steps/map_step.hpp"

#include <algorithm>
#include <span>

#include "mapping/map_update.hpp"
#include "mapping/store/taken_back.hpp"

namespace deltamap::daemon {
namespace {

constexpr std::size_t kMostProvisional = 256;  // revisions that may still be taken back; older ones count as settled

/// Adds to the note how many cells were added, freed and forgotten, and the box around them.
ChangeNote with_cells(ChangeNote note, std::span<const CellChange> changes, const GridGeometry& geometry) {
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

ChangeNote note_of(const ScanSet& set, std::span<const CellChange> changes, const GridGeometry& geometry) {
  ChangeNote note;
  note.time = set.ended;
  note.phase = set.phase;
  note.scans = static_cast<std::uint32_t>(set.scans.size());
  note.covariance = set.covariance;
  return with_cells(std::move(note), changes, geometry);
}

}  // namespace

MapStep::MapStep(const Settings& settings, StartMap start)
    : method_{settings.mapping.store_scan.method == MappingMethod::kPaper ? "paper" : "evidence"},
      update_{settings.mapping.update},
      localizer_{settings.localizer},
      newest_{std::move(start)},
      operator_cells_{{.hold_s = settings.mapping.store_scan.evidence.passing.persistence_s,
                       .margin_cells = settings.mapping.update.evidence.added_reach_cells}} {
  for (ProvisionalRevision& revision : newest_.provisional) {
    provisional_.push_back({std::move(revision), Timestamp::min()});
  }
  newest_.provisional.clear();
  if (newest_.site) set_zones(newest_.site->zones);
}

mapping::scan_set::MapUpdate MapStep::allowed(mapping::scan_set::MapUpdate update, const ScanSet& set) const {
  using mapping::scan_set::Refusal;
  if (!update.accepted()) return update;
  const GridGeometry& geometry = newest_.map->geometry();
  std::erase_if(update.changes,
                [&](const CellChange& change) { return unwritten_.covers(geometry.centre_of(change.cell)); });
  if (update.changes.empty()) {
    update.refusal = Refusal::kZoned;
    return update;
  }
  update.changes = operator_cells_.allowed(std::move(update.changes), set);
  if (update.changes.empty()) update.refusal = Refusal::kSetByOperator;
  return update;
}

std::vector<ProvisionalRevision> MapStep::provisional() const {
  std::vector<ProvisionalRevision> all;
  for (const Provisional& one : provisional_) all.push_back(one.revision);
  return all;
}

std::vector<std::uint32_t> MapStep::provisional_numbers() const {
  std::vector<std::uint32_t> numbers;
  for (const Provisional& one : provisional_) numbers.push_back(one.revision.number);
  return numbers;
}

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

std::optional<MapStep::Result> MapStep::take(const MapRequest& request) {
  if (const auto* settlement = std::get_if<Settlement>(&request)) {
    settle(settlement->before);
    return std::nullopt;
  }
  const auto* set = std::get_if<ScanSet>(&request);
  Result result = set != nullptr ? update(*set) : withdraw(std::get<WithdrawOrder>(request));
  result.provisional = provisional_numbers();
  return result;
}

MapStep::Result MapStep::update(const ScanSet& set) {
  settle(set.settled);
  mapping::scan_set::MapUpdate update = allowed(mapping::map_update(*newest_.map, set, update_), set);
  Result result{.revision = std::nullopt, .note = note_of(set, update.changes, newest_.map->geometry())};
  result.note.acceptance = update.acceptance;
  if (!update.accepted()) {
    result.refusal = update.refusal;
    result.note.reason = name_of(update.refusal);
    return result;
  }
  result.revision = publish(set.ended, std::move(update.changes));
  result.note.revision = result.revision->number;
  provisional_.push_back({{result.revision->number, result.revision->changes}, set.ended});
  return result;
}

MapStep::Result MapStep::obey(const SetCells& wanted) {
  const GridGeometry& geometry = newest_.map->geometry();
  Result result;
  result.provisional = provisional_numbers();
  result.note.time = wanted.order.scan_time;
  result.note.by_operator = true;
  result.note.reason = reason_of(wanted.order);
  if (wanted.width != geometry.width || wanted.height != geometry.height) {
    result.note.reason += ": another map";
    return result;
  }
  operator_cells_.hold(geometry, wanted.changes, wanted.order.scan_time);
  std::vector<CellChange> changes;
  for (const auto& [cell, before, after] : wanted.changes) {
    const CellState now = (*newest_.map)[cell];
    if (now != after) changes.push_back({cell, now, after});
  }
  result.note = with_cells(std::move(result.note), changes, geometry);
  if (changes.empty()) {
    result.note.reason += ": it is so already";
    return result;
  }
  result.revision = publish(wanted.order.scan_time, std::move(changes));
  result.note.revision = result.revision->number;
  return result;
}

MapStep::Result MapStep::withdraw(const WithdrawOrder& order) {
  OccupancyGrid map = *newest_.map;
  std::vector<std::uint32_t> withdrawn;
  while (!provisional_.empty() && provisional_.back().time >= order.from) {
    const std::vector<CellChange> back = mapping::store::taken_back(map, provisional_.back().revision.changes);
    map = patched(std::move(map), back);
    withdrawn.push_back(provisional_.back().revision.number);
    provisional_.pop_back();
  }
  std::vector<CellChange> changes = changes_between(*newest_.map, map);
  ChangeNote note;
  note.time = order.time;
  note.covariance = order.covariance;
  Result result{.revision = std::nullopt, .note = with_cells(std::move(note), changes, map.geometry())};
  result.note.reason = changes.empty() ? "nothing to withdraw" : "withdrawn";
  if (changes.empty()) return result;
  std::reverse(withdrawn.begin(), withdrawn.end());
  result.note.withdraws = std::move(withdrawn);
  result.revision = publish(order.time, std::move(changes));
  result.note.revision = result.revision->number;
  return result;
}

}  // namespace deltamap::daemon
