// SPDX-License-Identifier: Apache-2.0
// Why cast the rays again: the votes tell which blocks differ, at the localizer's poses; which of their cells are
// occupied only all keyframes together tell, at corrected poses. Walls away from the verdicts are neither written nor
// freed, so that an update does no harm there.
#include "mapping/redraw/evidence_update.hpp"

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "mapping/redraw/cell_group.hpp"
#include "mapping/redraw/closed_faces.hpp"
#include "mapping/redraw/enclosed_free_space.hpp"
#include "mapping/redraw/map_draft.hpp"
#include "mapping/redraw/ray_counts.hpp"
#include "mapping/registration/acceptance.hpp"

namespace deltamap::mapping::redraw {
namespace {

constexpr int kLeastOpaqueCells = 10;  // of a surface
constexpr int kDrawnAheadPasses = 8;
constexpr int kDrawnAheadReach = 3;       // cells
constexpr double kDrawnAheadShare = 0.1;  // of the beams, and of the hits behind
constexpr int kRemnantReach = 2;          // cells from what has been freed
constexpr int kRemnantCells = 6;          // larger groups are none
constexpr int kSurfaceCells = 17;         // smaller groups are small objects

/// The cells around the verdicts, and what they may become.
class DoubtMask {
 public:
  DoubtMask(const GridGeometry& map, const std::vector<CellVerdict>& verdicts, const EvidenceUpdateParams& params) {
    std::vector<CellChange> places;
    places.reserve(verdicts.size());
    for (const CellVerdict& verdict : verdicts) places.push_back({.cell = verdict.cell});
    box_ = grown(bounding_box(places), std::max(params.added_reach_cells, params.removed_reach_cells), map);
    flags_.assign(box_.cell_count(), 0);
    for (const CellVerdict& verdict : verdicts) {
      const bool added = verdict.state == CellState::kOccupied;
      mark(verdict.cell, added ? params.added_reach_cells : params.removed_reach_cells, added ? kAdded : kRemoved);
      if (!added) mark(verdict.cell, 0, kGone);
    }
  }

  [[nodiscard]] const CellBox& box() const { return box_; }
  [[nodiscard]] bool contains(Cell cell) const { return flags(cell) != 0; }
  [[nodiscard]] bool may_be_added(Cell cell) const { return (flags(cell) & kAdded) != 0; }
  [[nodiscard]] bool may_be_removed(Cell cell) const { return (flags(cell) & kRemoved) != 0; }
  /// The verdict was on this very cell.
  [[nodiscard]] bool is_gone(Cell cell) const { return (flags(cell) & kGone) != 0; }

 private:
  static constexpr std::uint8_t kAdded = 1;
  static constexpr std::uint8_t kRemoved = 2;
  static constexpr std::uint8_t kGone = 4;

  [[nodiscard]] std::uint8_t flags(Cell cell) const { return box_.contains(cell) ? flags_[box_.index_of(cell)] : 0; }

  void mark(Cell middle, int reach, std::uint8_t flag) {
    for (int row = -reach; row <= reach; ++row) {
      for (int column = -reach; column <= reach; ++column) {
        const Cell cell{middle.column + column, middle.row + row};
        if (box_.contains(cell)) flags_[box_.index_of(cell)] |= flag;
      }
    }
  }

  CellBox box_;
  std::vector<std::uint8_t> flags_;
};

/// Noise strews the hits of a face over the cells before it: those are few beside the face's own.
bool is_strewn(const RayCounts& counts, Cell cell, double least_of_face) {
  int most = 0;
  for (int row = cell.row - kDrawnAheadReach; row <= cell.row + kDrawnAheadReach; ++row) {
    for (int column = cell.column - kDrawnAheadReach; column <= cell.column + kDrawnAheadReach; ++column) {
      if (counts.box().contains({column, row})) most = std::max(most, static_cast<int>(counts[{column, row}].hits));
    }
  }
  return counts[cell].hits < least_of_face * most;
}

/// A face that was drawn some cells too far ahead: nearly all beams go on to the cells behind.
bool is_drawn_ahead(const RayCounts& counts, Cell cell) {
  const RayCount count = counts[cell];
  return count.passes >= kDrawnAheadPasses && count.hit_share() <= kDrawnAheadShare &&
         is_strewn(counts, cell, kDrawnAheadShare);
}

CellState state_after(const OccupancyGrid& map, CellState before, Cell cell, const RayCounts& counts,
                      const DoubtMask& mask, const EvidenceUpdateParams& params) {
  const RayCount count = counts[cell];
  const int decisive = count.hits + count.clear_passes;
  const bool is_free =
      count.clear_passes >= params.free_passes && count.hits <= params.free_hit_share * static_cast<double>(decisive);
  if (before == CellState::kOccupied) {
    // A verdict on a small object comes from beams beside it as well.
    const bool is_gone = mask.is_gone(cell) && count.hits == 0 && group_size(map, cell, kSurfaceCells) < kSurfaceCells;
    const bool goes =
        (mask.may_be_removed(cell) && is_free) || is_gone || (mask.may_be_added(cell) && is_drawn_ahead(counts, cell));
    return goes ? CellState::kFree : before;
  }
  if (mask.may_be_added(cell) && count.hits >= params.occupied_hits && count.hit_share() >= params.occupied_hit_share) {
    return CellState::kOccupied;
  }
  return before == CellState::kUnknown && is_free ? CellState::kFree : before;
}

/// With what the beams contradict around the verdicts, and the unknown cells anywhere that they have seen free.
[[nodiscard]] MapDraft with_contradicted_cells(MapDraft draft, const OccupancyGrid& map, const RayCounts& counts,
                                               const DoubtMask& mask, const EvidenceUpdateParams& params) {
  const auto decide = [&](Cell cell) { draft.set(cell, state_after(map, map[cell], cell, counts, mask, params)); };
  counts.for_each_clear(params.free_passes, [&](Cell cell) {
    if (map[cell] == CellState::kUnknown && !mask.contains(cell)) decide(cell);
  });
  for (int row = mask.box().first.row; row < mask.box().last.row; ++row) {
    for (int column = mask.box().first.column; column < mask.box().last.column; ++column) {
      if (mask.contains({column, row}) && counts.box().contains({column, row})) decide({column, row});
    }
  }
  return draft;
}

/// What surfaces have closed off from the robot is not known any longer: floor beside new ones, and floor that beams
/// saw before they stood there.
[[nodiscard]] MapDraft without_enclosed_free_space(MapDraft draft, const std::vector<PlacedScan>& scans,
                                                   double most_enclosed_m2) {
  std::vector<Cell> starts;
  for (const auto& [cell, was, is] : draft.changes()) {
    if (is == CellState::kFree && was == CellState::kUnknown) starts.push_back(cell);
    if (is != CellState::kOccupied) continue;
    for (const Cell& side : {Cell{1, 0}, Cell{-1, 0}, Cell{0, 1}, Cell{0, -1}})
      starts.push_back({cell.column + side.column, cell.row + side.row});
  }
  std::vector<Point2> robot_was;
  robot_was.reserve(scans.size());
  for (const PlacedScan& scan : scans) robot_was.push_back(scan.map_from_robot.position());
  for (const Cell& cell : enclosed_free_space(draft.map(), starts, robot_was, most_enclosed_m2)) {
    draft.set(cell, CellState::kUnknown);
  }
  return draft;
}

[[nodiscard]] MapDraft without_small_groups(MapDraft draft, int least_cells) {
  std::vector<CellChange> groups = draft.changes();
  std::erase_if(groups, [&](const CellChange& change) {
    return change.after != CellState::kOccupied || group_size(draft.map(), change.cell, least_cells) >= least_cells;
  });
  for (const CellChange& group : groups) draft.set(group.cell, group.before);
  return draft;
}

/// A few cells that are left of what has been freed around them go too, unless something was met there.
[[nodiscard]] MapDraft without_remnants(MapDraft draft, const RayCounts& counts, const DoubtMask& mask,
                                        int least_passes) {
  const auto is_remnant = [&](Cell cell) {
    return draft.map().at(cell) == CellState::kOccupied && mask.may_be_removed(cell) && counts.box().contains(cell) &&
           counts[cell].hits == 0 && counts[cell].passes >= least_passes &&
           group_size(draft.map(), cell, kRemnantCells) < kRemnantCells;
  };
  for (const CellChange& change : draft.changes()) {
    if (change.after != CellState::kFree || change.before != CellState::kOccupied) continue;
    for (int row = -kRemnantReach; row <= kRemnantReach; ++row) {
      for (int column = -kRemnantReach; column <= kRemnantReach; ++column) {
        const Cell cell{change.cell.column + column, change.cell.row + row};
        if (is_remnant(cell)) draft.set(cell, CellState::kFree);
      }
    }
  }
  return draft;
}

/// Eq. 11 of the map and the local map that the counts are: occupied where enough of the beams ended.
registration::Acceptance acceptance(const RayCounts& counts, const OccupancyGrid& map, double occupied_hit_share) {
  registration::Acceptance cells;
  counts.for_each_seen([&](Cell cell, const RayCount& count) {
    const bool occupied = count.hits > 0 && count.hit_share() >= occupied_hit_share;
    cells.add(map[cell], occupied ? CellState::kOccupied : CellState::kFree);
  });
  return cells;
}

scan_set::MapUpdate refused(scan_set::Refusal refusal) {
  scan_set::MapUpdate update;
  update.refusal = refusal;
  return update;
}

}  // namespace

scan_set::MapUpdate evidence_update(const OccupancyGrid& map, const ScanSet& set, const EvidenceUpdateParams& params) {
  if (set.scans.size() < params.least_scans) return refused(scan_set::Refusal::kTooFewScans);
  if (set.verdicts.empty()) return refused(scan_set::Refusal::kNothingChanged);
  const DoubtMask mask{map.geometry(), set.verdicts, params};
  const Placement placement = placed_scans(
      map, set.scans, [&](Cell cell) { return mask.contains(cell); }, params.placement);
  if (placement.implausible > params.most_implausible_share * static_cast<double>(set.scans.size()) ||
      placement.scans.size() < params.least_scans) {
    return refused(scan_set::Refusal::kImplausible);
  }

  const CellBox in_doubt = grown(mask.box(), kDrawnAheadReach, map.geometry());
  RayCounts counts{map.geometry(), box_seen(map.geometry(), placement.scans, params.longest_m, in_doubt)};
  counts.look_at(in_doubt);
  // Only what is in doubt can be seen through, and small objects, which beams pass by.
  counts.stop_at(map, [&](Cell cell) {
    return !mask.may_be_removed(cell) && group_size(map, cell, kLeastOpaqueCells) == kLeastOpaqueCells;
  });
  for (const PlacedScan& scan : placement.scans) counts.add(scan, params.longest_m);
  scan_set::MapUpdate update;
  MapDraft draft = with_contradicted_cells(MapDraft{map}, map, counts, mask, params);
  draft = with_closed_faces(std::move(draft), counts, placement.scans, mask.box(),
                            [&](Cell cell) { return mask.may_be_added(cell); }, {params.longest_m, params.free_passes});
  draft = without_small_groups(std::move(draft), params.least_group_cells);
  draft = without_remnants(std::move(draft), counts, mask, params.free_passes);
  draft = without_enclosed_free_space(std::move(draft), placement.scans, params.most_enclosed_m2);
  update.changes = draft.changes();
  update.acceptance = acceptance(counts, draft.map(), params.occupied_hit_share).value();
  if (update.changes.size() < set.least_changes) update.refusal = scan_set::Refusal::kNothingChanged;
  if (update.acceptance < params.least_acceptance) update.refusal = scan_set::Refusal::kLowAcceptance;
  if (!update.accepted()) update.changes.clear();
  return update;
}

}  // namespace deltamap::mapping::redraw
