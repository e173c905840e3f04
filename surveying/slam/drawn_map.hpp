// SPDX-License-Identifier: Apache-2.0
// The grid that keyframes draw at their poses.
#pragma once

#include <span>

#include "core/grid/occupancy_grid.hpp"
#include "mapping/alignment/local_map.hpp"
#include "surveying/slam/survey.hpp"

namespace deltamap::surveying::slam {

/// By how much to turn the frame so that most surfaces lie along an axis of the grid, in [-45°, 45°), rad.
[[nodiscard]] double turn_to_axes(const Survey& survey);

/// Of the drives that are joined to the first. A cell is occupied where a quarter of its beams, and two at least, ended
/// in it. Borders of cells lie on multiples of the resolution; `resolution_m` > 0.
[[nodiscard]] OccupancyGrid drawn_map(const Survey& survey, const Pose2& map_from_survey, double resolution_m);

/// Of these keyframes, in another frame than the survey's.
[[nodiscard]] OccupancyGrid drawn_map(const Survey& survey, std::span<const std::uint32_t> nodes,
                                      const Pose2& map_from_survey, double resolution_m,
                                      const mapping::alignment::LocalMapParams& params);

}  // namespace deltamap::surveying::slam
