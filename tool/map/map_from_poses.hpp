// SPDX-License-Identifier: Apache-2.0
// A grid from a CARMEN log whose laser poses are known: every valid range is cast as a ray, each cell counts how often
// a beam ended in it and how often one went through. The poses are taken as they stand: raw odometry makes a bent map.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>

#include "core/grid/occupancy_grid.hpp"
#include "drivers/carmen/carmen_survey.hpp"

namespace deltamap::tool {

struct MapFromPosesParams {
  double resolution_m = 0.05;    ///< > 0
  double occupied_ratio = 0.25;  ///< a cell is occupied where at least this share of its beams ended in it; (0, 1]
  unsigned least_hits = 2;       ///< and at least so many: one alone is a passer-by or an edge; >= 1
  double margin_m = 0.5;         ///< of unknown cells around everything that was seen; >= 0
  std::optional<double> no_return_m{};  ///< stands in for the log's largest values (carmen_survey.hpp)
};

struct MapFromPoses {
  OccupancyGrid grid;
  std::size_t scans = 0;
  std::size_t beams = 0;  ///< with a valid range
  drivers::carmen::CarmenSurvey survey;
};

/// Throws std::runtime_error: one line that names the log and the place (a scan without a pose, no valid range, too
/// large). A log that was cut is used up to the cut; times are not looked at.
[[nodiscard]] MapFromPoses map_from_poses(const std::filesystem::path& log, const MapFromPosesParams& params);

}  // namespace deltamap::tool
