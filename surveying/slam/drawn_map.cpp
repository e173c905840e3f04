// SPDX-License-Identifier: Apache-2.0
#include "surveying/slam/drawn_map.hpp"

#include <cmath>
#include <vector>

namespace deltamap::surveying::slam {
namespace {

constexpr double kLongestDrawnM = 25.0;  // beyond, neighbouring beams leave cells out

}  // namespace

double turn_to_axes(const Survey& survey) {
  double sine = 0.0;
  double cosine = 0.0;
  for (const std::uint32_t node : survey.joined_nodes()) {
    for (const Eigen::Vector2f& normal : survey.keyframes[node].normals) {
      if (normal.isZero(0.0F)) continue;
      const double angle = survey.poses[node].theta + std::atan2(double(normal.y()), double(normal.x()));
      sine += std::sin(4.0 * angle);
      cosine += std::cos(4.0 * angle);
    }
  }
  return -std::atan2(sine, cosine) / 4.0;
}

OccupancyGrid drawn_map(const Survey& survey, std::span<const std::uint32_t> nodes, const Pose2& map_from_survey,
                        double resolution_m, const mapping::alignment::LocalMapParams& params) {
  std::vector<Pose2> poses;
  for (const std::uint32_t node : nodes) poses.push_back(map_from_survey * survey.poses[node]);
  TrackedScan unpacked;
  const mapping::alignment::ScanSource scan_at = [&](std::size_t k) -> const TrackedScan& {
    unpacked = survey.keyframes[nodes[k]].scan.tracked();
    return unpacked;
  };
  return mapping::alignment::local_map(scan_at, poses, {0, 0, resolution_m, {0.0, 0.0}}, params);
}

OccupancyGrid drawn_map(const Survey& survey, const Pose2& map_from_survey, double resolution_m) {
  return drawn_map(survey, survey.joined_nodes(), map_from_survey, resolution_m,
                   {.longest_m = kLongestDrawnM, .least_hits = 2});
}

}  // namespace deltamap::surveying::slam
