// SPDX-License-Identifier: Apache-2.0
// What the cells of a map leave open of a pose that is found by its surfaces: each surface lies anywhere in the cells
// that it is drawn with, and does so whenever it is seen again.
#pragma once

#include <Eigen/Core>
#include <span>

#include "localization/surfaces/offset_state.hpp"
#include "localization/surfaces/surface_switch.hpp"

namespace deltamap::localization::surfaces {

/// Covariances of the position, map frame, m²; zero where no surface is followed.
struct UnknownOfCells {
  Eigen::Matrix2d scattered;  ///< were each face off its cells in its own way: the error of their mean
  Eigen::Matrix2d alike;      ///< what comes on top where they are off alike, or drawn worse than their cells allow
};

/// `switches[i]` is that of surface i of the state. In a building whose walls stand at whole cells from each other all
/// are off alike, and a hundred tell no more than one. How they are scattered about the pose tells.
[[nodiscard]] UnknownOfCells unknown_of_cells(std::span<const SurfaceSwitch> switches, const OffsetState& state);

}  // namespace deltamap::localization::surfaces
