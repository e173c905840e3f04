// SPDX-License-Identifier: Apache-2.0
#include "localization/odometer/line_points.hpp"

#include <algorithm>
#include <cmath>

#include "core/geometry/angle.hpp"

namespace deltamap::localization::odometer {
namespace {

constexpr double kBesideM = 0.18;  // to either side of an end
const double kLeastBesideRad = radians(2.0);
const double kMostBesideRad = radians(12.0);
// Two ends beside each other lie on one surface unless their ranges differ by more: seen at a slant of 12.5°.
constexpr double kConnectedM = 0.1;
constexpr double kSlant = 4.5;
// Of the ends about their line: across it at most, along it at least, variances.
constexpr double kAcross_m2 = 0.025 * 0.025;
constexpr double kAlong_m2 = 0.03 * 0.03;
constexpr double kLongerThanWide = 6.0;

}  // namespace

void LinePointFinder::gather(const Scan& scan, std::span<const RayInRobot> rays) {
  ends_.clear();
  sums_.assign(1, {});
  for (std::size_t beam = 0; beam < rays.size(); ++beam) {
    if (scan.beams[beam].kind != BeamKind::kRange) continue;
    const std::size_t i = ends_.size();
    bool goes_on = false;
    if (i > 0 && ends_[i - 1].beam + 1 == beam) {
      const double range_m = scan.beams[beam].range_m;
      const double step_m = std::abs(range_m - static_cast<double>(scan.beams[beam - 1].range_m));
      goes_on = step_m < std::max(kConnectedM, kSlant * range_m * scan.bearing_step_rad);
    }
    ends_.push_back({beam, goes_on ? ends_[i - 1].first : i, 0});
    const double x = rays[beam].end.x();
    const double y = rays[beam].end.y();
    const Sums& before = sums_.back();
    sums_.push_back({before.x + x, before.y + y, before.xx + x * x, before.xy + x * y, before.yy + y * y});
  }
  std::size_t past = ends_.size();
  for (std::size_t i = ends_.size(); i-- > 0;) {
    ends_[i].past = past;
    if (ends_[i].first == i) past = i;
  }
}

std::span<const LinePoint> LinePointFinder::points_of(const Scan& scan, std::span<const RayInRobot> rays) {
  gather(scan, rays);
  points_.clear();
  const double step_rad = std::max(1e-6, scan.bearing_step_rad);
  for (std::size_t i = 0; i < ends_.size(); ++i) {
    const End& end = ends_[i];
    const RayInRobot& ray = rays[end.beam];
    LinePoint& point = points_.emplace_back(LinePoint{ray.end});
    point.sector = static_cast<std::uint8_t>(end.beam * kSectors / rays.size());
    const double beside_rad = kBesideM / std::max(0.05, static_cast<double>(scan.beams[end.beam].range_m));
    const auto beside =
        static_cast<std::size_t>(std::lround(std::clamp(beside_rad, kLeastBesideRad, kMostBesideRad) / step_rad));
    const std::size_t first = std::max(end.first, i - std::min(i, beside));
    const std::size_t past = std::min(end.past, i + beside + 1);
    if (past - first < 3) continue;
    const double n = static_cast<double>(past - first);
    const Sums& a = sums_[first];
    const Sums& b = sums_[past];
    const double mean_x = (b.x - a.x) / n;
    const double mean_y = (b.y - a.y) / n;
    const double xx = (b.xx - a.xx) / n - mean_x * mean_x;
    const double xy = (b.xy - a.xy) / n - mean_x * mean_y;
    const double yy = (b.yy - a.yy) / n - mean_y * mean_y;
    const double middle = 0.5 * (xx + yy);
    const double half = std::sqrt(0.25 * (xx - yy) * (xx - yy) + xy * xy);
    const double across = middle - half;
    const double along = middle + half;
    if (across > kAcross_m2 || along < kAlong_m2 || along < kLongerThanWide * across) continue;
    // The eigenvector of the smaller one, by whichever of its two forms does not vanish.
    Eigen::Vector2d normal = xx > yy ? Eigen::Vector2d{xy, across - xx} : Eigen::Vector2d{across - yy, xy};
    const double length = normal.norm();
    if (!(length > 0.0)) continue;
    normal /= length;
    const Eigen::Vector2d at{ray.end.x(), ray.end.y()};
    const double off_m = normal.dot(at - Eigen::Vector2d{mean_x, mean_y});
    point.at = (at - off_m * normal).cast<float>();
    if (normal.dot(ray.origin.cast<double>() - at) < 0.0) normal = -normal;
    point.normal = normal.cast<float>();
  }
  return points_;
}

}  // namespace deltamap::localization::odometer
