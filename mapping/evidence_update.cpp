// SPDX-License-Identifier: Apache-2.0
#include "mapping/evidence_update.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "core/grid_ray.hpp"
#include "mapping/awareness/cell_group.hpp"
#include "mapping/awareness/face_step.hpp"
#include "mapping/hidden_floor.hpp"
#include "mapping/merge/acceptance.hpp"
#include "mapping/ray_counts.hpp"

namespace deltamap::mapping {
namespace {

constexpr int kLeastOpaqueCells = 10;  // of a surface
constexpr int kDrawnAheadPasses = 8;
constexpr double kDrawnAheadShare = 0.1;  // of the beams, and of the hits behind
constexpr int kRemnantReach = 2;          // cells from what has been freed
constexpr int kRemnantCells = 6;          // larger groups are none
constexpr int kSurfaceCells = 17;         // smaller groups are specks

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

/// Noise strews the hits of a face over the cells before it: those are few beside the face's own.
bool is_strewn(const RayCounts& counts, Cell cell, double least_of_face) {
  int most = 0;
  for (int row = cell.row - 1; row <= cell.row + 1; ++row) {
    for (int column = cell.column - 1; column <= cell.column + 1; ++column) {
      if (counts.box().contains({column, row})) most = std::max(most, static_cast<int>(counts[{column, row}].hits));
    }
  }
  return counts[cell].hits < least_of_face * most;
}

/// A face that was drawn a cell too far ahead: nearly all beams go on to the cell behind.
bool is_drawn_ahead(const RayCounts& counts, Cell cell) {
  const RayCount& count = counts[cell];
  return count.passes >= kDrawnAheadPasses && count.hit_share() <= kDrawnAheadShare &&
         is_strewn(counts, cell, kDrawnAheadShare);
}

CellState state_after(const OccupancyGrid& map, CellState before, Cell cell, const RayCounts& counts,
                      const DoubtMask& mask, const EvidenceUpdateParams& params) {
  const RayCount& count = counts[cell];
  const int decisive = count.hits + count.clear_passes;
  const bool is_free =
      count.clear_passes >= params.free_passes && count.hits <= params.free_hit_share * static_cast<double>(decisive);
  if (before == CellState::kOccupied) {
    // A verdict on a speck comes from beams beside it as well.
    const bool is_gone =
        mask.is_gone(cell) && count.hits == 0 && awareness::group_size(map, cell, kSurfaceCells) < kSurfaceCells;
    const bool goes =
        (mask.may_be_removed(cell) && is_free) || is_gone || (mask.may_be_added(cell) && is_drawn_ahead(counts, cell));
    return goes ? CellState::kFree : before;
  }
  if (mask.may_be_added(cell) && count.hits >= params.occupied_hits && count.hit_share() >= params.occupied_hit_share) {
    return CellState::kOccupied;
  }
  return before == CellState::kUnknown && is_free ? CellState::kFree : before;
}

/// Cells around the verdicts that the beams contradict, and unknown ones anywhere that they have seen free.
std::vector<CellChange> contradicted_cells(const OccupancyGrid& map, const RayCounts& counts, const DoubtMask& mask,
                                           const EvidenceUpdateParams& params) {
  std::vector<CellChange> changes;
  const CellBox& box = counts.box();
  for (int row = box.first.row; row < box.last.row; ++row) {
    for (int column = box.first.column; column < box.last.column; ++column) {
      const Cell cell{column, row};
      const CellState before = map[cell];
      if (before != CellState::kUnknown && !mask.contains(cell)) continue;
      const CellState after = state_after(map, before, cell, counts, mask, params);
      if (after != before) changes.push_back({cell, before, after});
    }
  }
  return changes;
}

/// Of the cell and its eight neighbours. For a gap of one cell in a line it is two.
int count_occupied_around(const OccupancyGrid& map, Cell cell) {
  int occupied = 0;
  for (int row = cell.row - 1; row <= cell.row + 1; ++row) {
    for (int column = cell.column - 1; column <= cell.column + 1; ++column) {
      occupied += map.at({column, row}) == CellState::kOccupied ? 1 : 0;
    }
  }
  return occupied;
}

/// A cell left out of a straight line of cells.
template <typename IsGap>
void close_pinholes(const CellBox& box, IsGap&& is_gap, OccupancyGrid& after) {
  const OccupancyGrid before = after;
  const auto is_occupied = [&](int column, int row) { return before.at({column, row}) == CellState::kOccupied; };
  for (int row = box.first.row; row < box.last.row; ++row) {
    for (int column = box.first.column; column < box.last.column; ++column) {
      const bool level = is_occupied(column - 1, row) && is_occupied(column + 1, row);
      const bool upright = is_occupied(column, row - 1) && is_occupied(column, row + 1);
      const bool beside = level ? is_occupied(column, row - 1) || is_occupied(column, row + 1)
                                : is_occupied(column - 1, row) || is_occupied(column + 1, row);
      if (level != upright && !beside && is_gap({column, row})) after.set({column, row}, CellState::kOccupied);
    }
  }
}

/// Between the ends of neighbouring beams on one face there is no gap, unless beams have gone through it.
[[nodiscard]] OccupancyGrid with_closed_faces(OccupancyGrid after, const RayCounts& counts, const DoubtMask& mask,
                                              const std::vector<PlacedScan>& scans,
                                              const EvidenceUpdateParams& params) {
  const auto is_drawn = [&](const Point2& end) {
    const Cell cell = after.geometry().cell_at(end);
    return mask.may_be_added(cell) && after.at(cell) == CellState::kOccupied;
  };
  const OccupancyGrid drawn = after;
  const auto is_gap = [&](Cell cell) {
    return count_occupied_around(drawn, cell) <= 2 && mask.may_be_added(cell) &&
           after.at(cell) != CellState::kOccupied && counts.box().contains(cell) &&
           counts[cell].clear_passes < params.free_passes;
  };
  for (const PlacedScan& scan : scans) {
    const TrackedScan& tracked = *scan.tracked;
    const auto length_m = [&](std::size_t i) {
      const Beam& beam = tracked.scan.beams[i];
      return beam.kind == BeamKind::kRange && beam.range_m <= params.longest_m ? static_cast<double>(beam.range_m)
                                                                               : 0.0;
    };
    const auto end = [&](std::size_t i) -> Point2 {
      return scan.map_from_robot * Point2{tracked.rays[i].end.cast<double>()};
    };
    const awareness::FaceParams face{.slant = params.face_slant, .bearing_step_rad = tracked.scan.bearing_step_rad};
    awareness::for_each_face_step(tracked.rays.size(), face, length_m, end, [&](std::size_t i) {
      if (!is_drawn(end(i)) || !is_drawn(end(i + 1))) return;
      walk_ray(drawn.geometry(), end(i), end(i + 1), [&](Cell cell, double) {
        if (is_gap(cell)) after.set(cell, CellState::kOccupied);
        return true;
      });
    });
  }
  close_pinholes(mask.box(), is_gap, after);
  return after;
}

/// What surfaces have closed off from the robot is not known any longer: floor beside new ones, and floor that beams
/// saw before they stood there.
[[nodiscard]] OccupancyGrid without_hidden_floor(const OccupancyGrid& map, OccupancyGrid after,
                                                 const std::vector<PlacedScan>& scans, double most_hidden_m2) {
  std::vector<Cell> starts;
  for (const auto& [cell, was, is] : changes_between(map, after)) {
    if (is == CellState::kFree && was == CellState::kUnknown) starts.push_back(cell);
    if (is != CellState::kOccupied) continue;
    for (const Cell& side : {Cell{1, 0}, Cell{-1, 0}, Cell{0, 1}, Cell{0, -1}})
      starts.push_back({cell.column + side.column, cell.row + side.row});
  }
  std::vector<Point2> robot_was;
  for (const PlacedScan& scan : scans) robot_was.push_back(scan.map_from_robot.position());
  for (const Cell& cell : hidden_floor(after, starts, robot_was, most_hidden_m2)) after.set(cell, CellState::kUnknown);
  return after;
}

[[nodiscard]] OccupancyGrid without_specks(const OccupancyGrid& map, const OccupancyGrid& after, int least_cells) {
  OccupancyGrid without = after;
  for (const CellChange& change : changes_between(map, after)) {
    if (change.after != CellState::kOccupied) continue;
    if (awareness::group_size(after, change.cell, least_cells) < least_cells) without.set(change.cell, change.before);
  }
  return without;
}

/// A few cells that are left of what has been freed around them go too, unless something was met there.
[[nodiscard]] OccupancyGrid without_remnants(const OccupancyGrid& map, OccupancyGrid after, const RayCounts& counts,
                                             const DoubtMask& mask, int least_passes) {
  const auto is_remnant = [&](Cell cell) {
    return after.at(cell) == CellState::kOccupied && mask.may_be_removed(cell) && counts.box().contains(cell) &&
           counts[cell].hits == 0 && counts[cell].passes >= least_passes &&
           awareness::group_size(after, cell, kRemnantCells) < kRemnantCells;
  };
  for (const CellChange& change : changes_between(map, after)) {
    if (change.after != CellState::kFree || change.before != CellState::kOccupied) continue;
    for (int row = -kRemnantReach; row <= kRemnantReach; ++row) {
      for (int column = -kRemnantReach; column <= kRemnantReach; ++column) {
        const Cell cell{change.cell.column + column, change.cell.row + row};
        if (is_remnant(cell)) after.set(cell, CellState::kFree);
      }
    }
  }
  return after;
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
  // Only what is in doubt can be seen through, and specks, which beams pass by.
  counts.stop_at(map, [&](Cell cell) {
    return !mask.may_be_removed(cell) && awareness::group_size(map, cell, kLeastOpaqueCells) == kLeastOpaqueCells;
  });
  for (const PlacedScan& scan : placement.scans) counts.add(scan, params.longest_m, params.clear_m);
  MapUpdate update;
  update.map_from_local = placement.mean_correction;
  OccupancyGrid after = patched(map, contradicted_cells(map, counts, mask, params));
  after = with_closed_faces(std::move(after), counts, mask, placement.scans, params);
  after = without_specks(map, after, params.least_speck_cells);
  after = without_remnants(map, std::move(after), counts, mask, params.free_passes);
  after = without_hidden_floor(map, std::move(after), placement.scans, params.most_hidden_m2);
  update.changes = changes_between(map, after);
  update.acceptance = merge::acceptance(counts.local_map(params.occupied_hit_share), after).value();
  if (update.changes.empty()) update.refusal = Refusal::kNothingChanged;
  if (update.acceptance < params.least_acceptance) update.refusal = Refusal::kLowAcceptance;
  if (!update.accepted()) update.changes.clear();
  return update;
}

}  // namespace deltamap::mapping
