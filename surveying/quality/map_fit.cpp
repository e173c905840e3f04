// SPDX-License-Identifier: Apache-2.0
#include "surveying/quality/map_fit.hpp"

#include <algorithm>
#include <cmath>

#include "core/geometry/points_in_map.hpp"
#include "surveying/quality/seen_walls.hpp"

namespace deltamap::surveying::quality {
namespace {

constexpr double kBesideM = 0.15;  // a cell, and what ranges and poses of a good map are unsure by
constexpr std::size_t kFewestEnds = 20;
constexpr double kLeastExplained = 0.5;

bool is_beside_wall(const OccupancyGrid& map, const Point2& place) {
  const Cell middle = map.geometry().cell_at(place);
  const int reach = std::max(1, static_cast<int>(std::lround(kBesideM / map.resolution_m())));
  for (int row = middle.row - reach; row <= middle.row + reach; ++row) {
    for (int column = middle.column - reach; column <= middle.column + reach; ++column) {
      if (map.at({column, row}) == CellState::kOccupied) return true;
    }
  }
  return false;
}

}  // namespace

ScanFit scan_fit(const OccupancyGrid& map, const PlacedScan& scan) {
  ScanFit fit;
  const PointsInMap in_map{scan.map_from_robot};
  for (std::size_t i = 0; i < scan.scan->size(); ++i) {
    if (!scan.scan->ends_within(i, kLongestSeenM)) continue;
    ++fit.ends;
    fit.explained += is_beside_wall(map, in_map(scan.scan->end(i))) ? 1 : 0;
  }
  return fit;
}

MapFit map_fit(const OccupancyGrid& map, std::span<const PlacedScan> scans) {
  MapFit fit;
  ScanFit all;
  double least = kLeastExplained;
  for (const PlacedScan& scan : scans) {
    const ScanFit of = scan_fit(map, scan);
    all.ends += of.ends;
    all.explained += of.explained;
    if (of.ends < kFewestEnds) continue;
    ++fit.scans;
    const double share = static_cast<double>(of.explained) / static_cast<double>(of.ends);
    fit.unfit += share < kLeastExplained ? 1 : 0;
    if (share >= least) continue;
    least = share;
    fit.worst = scan.map_from_robot.position();
  }
  if (all.ends > 0) fit.explained_share = static_cast<double>(all.explained) / static_cast<double>(all.ends);
  return fit;
}

}  // namespace deltamap::surveying::quality
