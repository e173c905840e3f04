// SPDX-License-Identifier: Apache-2.0
#include "navigation/fan.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace deltamap::navigation {
namespace {

constexpr double kTurnRad = 2.0 * std::numbers::pi;
constexpr double kRoundingRad = 1e-6;
constexpr int kCornerSteps = 8;  // across the strip: a mount beside the middle may see both corners and not between

}  // namespace

Fan fan_of(const Scan& scan) {
  const double steps = static_cast<double>(scan.beams.empty() ? 0 : scan.beams.size() - 1);
  const double signed_rad = steps * scan.bearing_step_rad;
  const double first_rad = signed_rad < 0.0 ? scan.first_bearing_rad + signed_rad : scan.first_bearing_rad;
  return {scan.robot_from_laser, first_rad, std::min(std::abs(signed_rad), kTurnRad)};
}

bool looks_at(const Fan& fan, const Point2& point_in_robot) {
  const Point2 in_laser = inverse(fan.robot_from_laser) * point_in_robot;
  double along_rad = std::remainder(std::atan2(in_laser.y(), in_laser.x()) - fan.first_rad, kTurnRad);
  if (along_rad < -kRoundingRad) along_rad += kTurnRad;
  return along_rad <= fan.width_rad + kRoundingRad;
}

std::optional<std::size_t> beam_towards(const Scan& scan, const Point2& point_in_laser) {
  if (scan.bearing_step_rad == 0.0) return std::nullopt;
  const double bearing = std::atan2(point_in_laser.y(), point_in_laser.x());
  const double step_rad = std::abs(scan.bearing_step_rad);
  double along_rad = std::remainder(bearing - scan.first_bearing_rad, kTurnRad);
  if (scan.bearing_step_rad < 0.0) along_rad = -along_rad;
  if (along_rad < -0.5 * step_rad) along_rad += kTurnRad;
  const auto beam = static_cast<std::size_t>(std::lround(std::max(0.0, along_rad) / step_rad));
  return beam < scan.beams.size() ? std::optional{beam} : std::nullopt;
}

bool covers_way_ahead(const Fan& fan, double radius_m) {
  for (int i = -kCornerSteps; i <= kCornerSteps; ++i) {
    const double aside_m = radius_m * i / kCornerSteps;
    if (!looks_at(fan, {radius_m, aside_m})) return false;
  }
  return true;
}

}  // namespace deltamap::navigation
