// SPDX-License-Identifier: Apache-2.0
#include "mapping/evidence_update.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "mapping/merge/acceptance.hpp"

namespace deltamap::mapping {
namespace {

/// The cells around the verdicts, and what they may become.
class DoubtMask {
 public:
  DoubtMask(const GridGeometry& map, const std::vector<CellVerdict>& verdicts, const EvidenceUpdateParams& params) {
    std::vector<CellChange> places;
    for (const CellVerdict& verdict : verdicts) places.push_back({.cell = verdict.cell});
    box_ = grown(bounding_box(places), std::max(params.added_reach_cells, params.removed_reach_cells), map);
    flags_.assign(box_.empty() ? 0 : static_cast<std::size_t>(box_.width()) * static_cast<std::size_t>(box_.height()),
                  0);
    for (const CellVerdict& verdict : verdicts) {
      const bool added = verdict.state == CellState::kOccupied;
      mark(verdict.cell, added ? params.added_reach_cells : params.removed_reach_cells, added ? kAdded : kRemoved);
    }
  }

  [[nodiscard]] const CellBox& box() const { return box_; }
  [[nodiscard]] bool contains(Cell cell) const { return flags(cell) != 0; }
  [[nodiscard]] bool may_be_added(Cell cell) const { return (flags(cell) & kAdded) != 0; }
  [[nodiscard]] bool may_be_removed(Cell cell) const { return (flags(cell) & kRemoved) != 0; }

 private:
  static constexpr std::uint8_t kAdded = 1;
  static constexpr std::uint8_t kRemoved = 2;

  [[nodiscard]] std::size_t index_of(Cell cell) const {
    return static_cast<std::size_t>(cell.row - box_.first.row) * static_cast<std::size_t>(box_.width()) +
           static_cast<std::size_t>(cell.column - box_.first.column);
  }
  [[nodiscard]] std::uint8_t flags(Cell cell) const { return box_.contains(cell) ? flags_[index_of(cell)] : 0; }

  void mark(Cell middle, int reach, std::uint8_t flag) {
    for (int row = -reach; row <= reach; ++row) {
      for (int column = -reach; column <= reach; ++column) {
        const Cell cell{middle.column + column, middle.row + row};
        if (box_.contains(cell)) flags_[index_of(cell)] |= flag;
      }
    }
  }

  CellBox box_;
  std::vector<std::uint8_t> flags_;
};

CellState state_after(CellState before, Cell cell, const RayCount& count, const DoubtMask& mask,
                      const EvidenceUpdateParams& params) {
  const int decisive = count.hits + count.clear_passes;
  const bool is_free =
      count.clear_passes >= params.free_passes && count.hits <= params.free_hit_share * static_cast<double>(decisive);
  if (before == CellState::kOccupied) return mask.may_be_removed(cell) && is_free ? CellState::kFree : before;
  if (mask.may_be_added(cell) && count.hits >= params.occupied_hits && count.hit_share() >= params.occupied_hit_share) {
    return CellState::kOccupied;
  }
  return before == CellState::kUnknown && is_free ? CellState::kFree : before;
}

std::vector<CellChange> contradicted_cells(const OccupancyGrid& map, const RayCounts& counts, const DoubtMask& mask,
                                           const EvidenceUpdateParams& params) {
  const int unknown_reach = static_cast<int>(std::ceil(params.unknown_reach_m / map.resolution_m()));
  const CellBox box = grown(mask.box(), unknown_reach, map.geometry());
  std::vector<CellChange> changes;
  for (int row = box.first.row; row < box.last.row; ++row) {
    for (int column = box.first.column; column < box.last.column; ++column) {
      const Cell cell{column, row};
      if (!counts.box().contains(cell)) continue;
      const CellState before = map[cell];
      if (before != CellState::kUnknown && !mask.contains(cell)) continue;
      const CellState after = state_after(before, cell, counts[cell], mask, params);
      if (after != before) changes.push_back({cell, before, after});
    }
  }
  return changes;
}

/// Occupied cells connected to `start` (8 neighbours), counted up to `enough`.
int group_size(const OccupancyGrid& map, Cell start, int enough) {
  std::vector<Cell> group{start};
  for (std::size_t next = 0; next < group.size() && static_cast<int>(group.size()) < enough; ++next) {
    for (int row = -1; row <= 1; ++row) {
      for (int column = -1; column <= 1; ++column) {
        const Cell cell{group[next].column + column, group[next].row + row};
        if (map.at(cell) == CellState::kOccupied && std::find(group.begin(), group.end(), cell) == group.end()) {
          group.push_back(cell);
        }
      }
    }
  }
  return static_cast<int>(group.size());
}

void leave_out_specks(const OccupancyGrid& map, std::vector<CellChange>& changes, int least_cells) {
  const OccupancyGrid after = patched(map, changes);
  std::erase_if(changes, [&](const CellChange& change) {
    return change.after == CellState::kOccupied && group_size(after, change.cell, least_cells) < least_cells;
  });
}

MapUpdate refused(Refusal refusal) {
  MapUpdate update;
  update.refusal = refusal;
  return update;
}

}  // namespace

MapUpdate evidence_update(const OccupancyGrid& map, const ScanSet& set, const EvidenceUpdateParams& params) {
  if (set.scans.size() < params.least_scans) return refused(Refusal::kTooFewScans);
  if (set.verdicts.empty()) return refused(Refusal::kNothingChanged);
  const DoubtMask mask{map.geometry(), set.verdicts, params};
  const Placement placement = placed_scans(
      map, set.scans, [&](Cell cell) { return mask.contains(cell); }, params.placement);
  if (placement.implausible > params.most_implausible_share * static_cast<double>(set.scans.size()) ||
      placement.scans.size() < params.least_scans) {
    return refused(Refusal::kImplausible);
  }

  RayCounts counts{map.geometry(), box_seen(map.geometry(), placement.scans, params.longest_m)};
  for (const PlacedScan& scan : placement.scans) counts.add(scan, params.longest_m, params.clear_m);
  MapUpdate update;
  update.map_from_local = placement.mean_correction;
  update.changes = contradicted_cells(map, counts, mask, params);
  leave_out_specks(map, update.changes, params.least_speck_cells);
  update.acceptance =
      merge::acceptance(counts.local_map(params.occupied_hit_share), patched(map, update.changes)).value();
  if (update.changes.empty()) update.refusal = Refusal::kNothingChanged;
  if (update.acceptance < params.least_acceptance) update.refusal = Refusal::kLowAcceptance;
  if (!update.accepted()) update.changes.clear();
  return update;
}

}  // namespace deltamap::mapping
