// SPDX-License-Identifier: Apache-2.0
// How the scans fit the finished map: which ends the map explains, and which beams go through what it has as occupied.
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "core/grid/occupancy_grid.hpp"
#include "surveying/quality/passes.hpp"

namespace deltamap::surveying::quality {

struct ScanFit {
  std::size_t ends = 0;       ///< of beams with a range of at most kLongestSeenM
  std::size_t explained = 0;  ///< ended beside an occupied cell
};
[[nodiscard]] ScanFit scan_fit(const OccupancyGrid& map, const PlacedScan& scan);

struct MapFit {
  std::size_t scans = 0;  ///< that have enough ends
  std::size_t unfit = 0;  ///< of which the map explains less than half
  double explained_share = 1.0;
  std::optional<Point2> worst{};  ///< where a scan fits least, if it is unfit
};
[[nodiscard]] MapFit map_fit(const OccupancyGrid& map, std::span<const PlacedScan> scans);

}  // namespace deltamap::surveying::quality
