// SPDX-License-Identifier: Apache-2.0
// What keyframes have seen to be free and to be solid: whether others, laid over it, contradict. Ends alone fit
// wherever something looks alike; a beam that goes through a wall, or ends where there was nothing, does not.
#pragma once

#include <span>

#include "core/grid/occupancy_grid.hpp"
#include "surveying/slam/survey.hpp"

namespace deltamap::surveying::slam {

class SeenSpace {
 public:
  /// Of these keyframes, in the frame of one of them.
  SeenSpace(const Survey& survey, std::span<const std::uint32_t> nodes, std::uint32_t frame);

  /// Share of the beams that end where these keyframes have seen free space, or go through what they have seen to be
  /// solid; of those beams that run and end in space that they have seen. 1 where there are none.
  [[nodiscard]] double contradicted(const Survey& survey, std::span<const std::uint32_t> nodes,
                                    std::uint32_t frame_of_nodes, const Pose2& seen_from_frame_of_nodes) const;

 private:
  [[nodiscard]] bool is_solid_near(Cell cell) const;

  OccupancyGrid seen_;
};

}  // namespace deltamap::surveying::slam
