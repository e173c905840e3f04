// SPDX-License-Identifier: Apache-2.0
#include "daemon/incidents/incident_picture.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "core/geometry/principal_axes.hpp"
#include "core/grid/near_occupied.hpp"
#include "daemon/maps/png_bytes.hpp"

namespace deltamap::daemon {
namespace {

constexpr int kMostPixels = 800;
constexpr int kLargestCell = 4;  // pixels
constexpr double kLeastReachM = 5.0;
constexpr double kMostReachM = 25.0;
constexpr double kMarginM = 1.0;
constexpr double kEndsAtM = 0.15;  // a beam ends at an obstacle of the map that is so near
constexpr double kDeviations = 2.0;
constexpr int kRobotPixels = 6;

// The first three are cells, by CellState; colours that colour-blind people tell apart.
enum Ink : std::uint8_t { kFree, kOccupied, kUnknown, kExpectedBeam, kDoubtedBeam, kBelievedPose, kOtherPose };
constexpr std::array<std::array<std::uint8_t, 3>, 7> kInks{
    {{255, 255, 255}, {24, 26, 30}, {204, 208, 213}, {0, 158, 115}, {213, 94, 0}, {0, 60, 180}, {204, 121, 167}}};

struct ScanEnd {
  Point2 in_map;
  bool is_expected;
};

std::vector<ScanEnd> ends_of(const IncidentScene& scene) {
  std::vector<ScanEnd> ends;
  if (!scene.scan) return ends;
  const Pose2 map_from_laser = scene.map_from_robot * scene.scan->robot_from_laser;
  for (std::size_t i = 0; i < scene.scan->beams.size(); ++i) {
    const Beam& beam = scene.scan->beams[i];
    if (beam.kind != BeamKind::kRange) continue;
    const double bearing_rad = scene.scan->bearing_rad(i);
    const Point2 end =
        map_from_laser * Point2{beam.range_m * std::cos(bearing_rad), beam.range_m * std::sin(bearing_rad)};
    ends.push_back({end, occupied_near(scene.map, end, kEndsAtM).has_value()});
  }
  return ends;
}

/// How far from the robot the picture reaches.
double reach_of(const IncidentScene& scene, const std::vector<ScanEnd>& ends) {
  double reach_m = kLeastReachM;
  for (const ScanEnd& end : ends) reach_m = std::max(reach_m, (end.in_map - scene.map_from_robot.position()).norm());
  return std::min(reach_m + kMarginM, kMostReachM);
}

/// A square around a place: as many pixels a cell as fit.
class Drawing {
 public:
  Drawing(const OccupancyGrid& map, const Point2& middle, double reach_m) : resolution_m_{map.geometry().resolution_m} {
    const double wanted = 2.0 * reach_m / resolution_m_;
    pixels_a_cell_ = std::min(static_cast<double>(kLargestCell), kMostPixels / wanted);
    side_ = std::min(kMostPixels, static_cast<int>(std::ceil(wanted * pixels_a_cell_)));
    corner_ = middle + Point2{-reach_m, reach_m};
    pixels_.resize(static_cast<std::size_t>(side_) * static_cast<std::size_t>(side_));
    for (int y = 0; y < side_; ++y) {
      for (int x = 0; x < side_; ++x) {
        const Point2 place = corner_ + metres_a_pixel() * Point2{x + 0.5, -(y + 0.5)};
        pixel(x, y) = static_cast<std::uint8_t>(map.at(map.geometry().cell_at(place)));
      }
    }
  }

  void dot(const Point2& place, int radius, Ink ink) {
    const auto [x, y] = pixel_at(place);
    for (int dy = -radius; dy <= radius; ++dy) {
      for (int dx = -radius; dx <= radius; ++dx) {
        if (dx * dx + dy * dy <= radius * radius + 1) put(x + dx, y + dy, ink);
      }
    }
  }
  void line(const Point2& from, const Point2& to, Ink ink) {
    const int steps = 1 + static_cast<int>((to - from).norm() / metres_a_pixel());
    for (int step = 0; step <= steps; ++step) dot(from + (static_cast<double>(step) / steps) * (to - from), 0, ink);
  }
  void pose(const Pose2& map_from_robot, Ink ink) {
    dot(map_from_robot.position(), kRobotPixels, ink);
    line(map_from_robot.position(), map_from_robot * Point2{4.0 * kRobotPixels * metres_a_pixel(), 0.0}, ink);
  }
  void ellipse(const Point2& middle, const Eigen::Matrix2d& covariance, Ink ink) {
    const PrincipalAxes axes = principal_axes(covariance);
    const Eigen::Vector2d radii = kDeviations * axes.values.cwiseMax(0.0).cwiseSqrt();
    constexpr int kCorners = 72;
    Point2 before = middle + axes.vectors * Point2{radii.x(), 0.0};
    for (int corner = 1; corner <= kCorners; ++corner) {
      const double turn_rad = 2.0 * std::numbers::pi * corner / kCorners;
      const Point2 next =
          middle + axes.vectors * Point2{radii.x() * std::cos(turn_rad), radii.y() * std::sin(turn_rad)};
      line(before, next, ink);
      before = next;
    }
  }
  [[nodiscard]] std::string png() const {
    return png_of(static_cast<std::size_t>(side_), static_cast<std::size_t>(side_), pixels_, kInks);
  }

 private:
  [[nodiscard]] double metres_a_pixel() const { return resolution_m_ / pixels_a_cell_; }
  [[nodiscard]] std::array<int, 2> pixel_at(const Point2& place) const {
    const Point2 off = (place - corner_) / metres_a_pixel();
    const double far = 2.0 * kMostPixels;
    return {static_cast<int>(std::floor(std::clamp(off.x(), -far, far))),
            static_cast<int>(std::floor(std::clamp(-off.y(), -far, far)))};
  }
  std::uint8_t& pixel(int x, int y) {
    return pixels_[static_cast<std::size_t>(y) * static_cast<std::size_t>(side_) + static_cast<std::size_t>(x)];
  }
  void put(int x, int y, Ink ink) {
    if (x >= 0 && y >= 0 && x < side_ && y < side_) pixel(x, y) = ink;
  }

  double resolution_m_;
  double pixels_a_cell_ = 1.0;
  int side_ = 0;
  Point2 corner_{0.0, 0.0};  // left and top
  std::vector<std::uint8_t> pixels_;
};

}  // namespace

std::string incident_picture(const IncidentScene& scene) {
  const std::vector<ScanEnd> ends = ends_of(scene);
  const Point2 robot = scene.map_from_robot.position();
  Drawing drawing{scene.map, robot, reach_of(scene, ends)};
  for (const ScanEnd& end : ends) drawing.dot(end.in_map, 1, end.is_expected ? kExpectedBeam : kDoubtedBeam);
  if (scene.map_from_other) drawing.pose(*scene.map_from_other, kOtherPose);
  drawing.pose(scene.map_from_robot, kBelievedPose);
  drawing.ellipse(robot, scene.covariance.topLeftCorner<2, 2>(), kBelievedPose);
  return drawing.png();
}

}  // namespace deltamap::daemon
