// SPDX-License-Identifier: Apache-2.0
// picture.png of an incident: the map around the robot, the newest scan at the believed pose, how sure that pose was,
// and the best other one.
#pragma once

#include <optional>
#include <string>

#include "core/grid/occupancy_grid.hpp"
#include "core/messages.hpp"

namespace deltamap::daemon {

struct IncidentScene {
  const OccupancyGrid& map;
  Pose2 map_from_robot;
  PoseCovariance covariance = PoseCovariance::Zero();
  std::optional<Pose2> map_from_other{};  ///< the best other pose hypothesis
  std::optional<Scan> scan{};             ///< measured there; nothing: the laser told none
};

/// The bytes of a PNG of at most 800 × 800 pixels, the highest row on top: free white, unknown grey, occupied black;
/// beams that end at an obstacle of the map green, others (doubted) orange; the robot blue, with its heading and the
/// ellipse of 2 σ; the other pose purple. Throws std::runtime_error where that cannot be encoded.
[[nodiscard]] std::string incident_picture(const IncidentScene& scene);

}  // namespace deltamap::daemon
