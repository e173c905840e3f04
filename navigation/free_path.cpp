// SPDX-License-Identifier: Apache-2.0
#include "navigation/free_path.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace deltamap::navigation {
namespace {

constexpr double kStraightPerM = 1e-3;  // an arc of 1 km radius: a line for all that a laser sees

bool is_unseen(const Beam& beam) { return beam.kind != BeamKind::kRange && beam.kind != BeamKind::kBeyondMaximum; }

/// Along a straight line the disc touches at x - sqrt(r² - y²).
double line_to(const Point2& point, double radius_m) {
  constexpr double kNever = std::numeric_limits<double>::infinity();
  if (point.x() <= 0.0 || std::abs(point.y()) >= radius_m) return kNever;
  return std::max(0.0, point.x() - std::sqrt(radius_m * radius_m - point.y() * point.y()));
}

/// On an arc to the left around (0, rho): the point lies at distance d from that centre and at angle `along` further
/// on; the disc touches it `before` that angle, where r² = rho² + d² - 2 rho d cos(before).
double left_arc_to(const Point2& point, double rho_m, double radius_m) {
  constexpr double kNever = std::numeric_limits<double>::infinity();
  const double to_point_x = point.x();
  const double to_point_y = point.y() - rho_m;
  const double d = std::hypot(to_point_x, to_point_y);
  if (std::abs(d - rho_m) >= radius_m) return kNever;
  if (point.norm() < radius_m) return point.x() > 0.0 ? 0.0 : kNever;
  if (rho_m * d == 0.0) return kNever;
  double along = std::atan2(to_point_x, -to_point_y);
  if (along < 0.0) along += 2.0 * std::numbers::pi;
  const double cosine = (rho_m * rho_m + d * d - radius_m * radius_m) / (2.0 * rho_m * d);
  const double before = std::acos(std::clamp(cosine, -1.0, 1.0));
  return std::max(0.0, along - before) * rho_m;
}

}  // namespace

std::vector<Point2> obstacles_of(const Scan& scan, const ObstacleParams& params) {
  std::vector<Point2> obstacles;
  obstacles.reserve(scan.beams.size());
  const auto add = [&](std::size_t beam, double range_m) {
    const double bearing = scan.bearing_rad(beam);
    obstacles.push_back(scan.robot_from_laser * Point2{range_m * std::cos(bearing), range_m * std::sin(bearing)});
  };
  for (std::size_t i = 0; i < scan.beams.size(); ++i) {
    if (scan.beams[i].kind == BeamKind::kRange) add(i, static_cast<double>(scan.beams[i].range_m));
    if (scan.beams[i].kind == BeamKind::kBeyondMaximum) add(i, scan.max_range_m);
    if (!is_unseen(scan.beams[i])) continue;
    std::size_t last = i;
    while (last + 1 < scan.beams.size() && is_unseen(scan.beams[last + 1])) ++last;
    const double gap_rad = static_cast<double>(last + 1 - i) * std::abs(scan.bearing_step_rad);
    const double hiding_m = params.hidden_width_m / gap_rad;
    for (std::size_t beam = i; beam <= last && hiding_m < scan.max_range_m; ++beam) add(beam, hiding_m);
    i = last;
  }
  return obstacles;
}

double free_path_m(std::span<const Point2> obstacles_in_robot, double curvature_per_m, double radius_m, double most_m) {
  double free_m = most_m;
  const double mirror = curvature_per_m < 0.0 ? -1.0 : 1.0;  // an arc to the right is one to the left in the mirror
  const bool straight = std::abs(curvature_per_m) < kStraightPerM;
  for (const Point2& point : obstacles_in_robot) {
    const Point2 seen{point.x(), mirror * point.y()};
    free_m = std::min(
        free_m, straight ? line_to(seen, radius_m) : left_arc_to(seen, 1.0 / std::abs(curvature_per_m), radius_m));
  }
  return free_m;
}

double nearest_m(std::span<const Point2> obstacles_in_robot) {
  double nearest_m = std::numeric_limits<double>::infinity();
  for (const Point2& point : obstacles_in_robot) nearest_m = std::min(nearest_m, point.norm());
  return nearest_m;
}

}  // namespace deltamap::navigation
