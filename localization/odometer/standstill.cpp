// SPDX-License-Identifier: Apache-2.0
#include "localization/odometer/standstill.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "core/geometry/points_in_map.hpp"

namespace deltamap::localization::odometer {
namespace {

constexpr double kDeviations = 2.8;
constexpr double kLeastShareSame = 0.75;
constexpr double kMostSameChi2 = 1.5;  // mean over the beams that are the same
constexpr std::size_t kFewestBeams = 20;

// What the wheels may be off in what they claim.
constexpr std::array kShares{0.6, 0.7, 0.8, 0.9, 1.0, 1.1, 1.2};
constexpr std::array kTurnsRad{0.0, -0.01, 0.01, -0.02, 0.02, -0.03, 0.03, -0.04, 0.04};
// Between those that are tried: half a step.
constexpr double kOffShare = 0.05;
constexpr double kOffRad = 0.005;
constexpr double kAlikeBeams = 3.0;   // neighbouring beams say the same
constexpr double kElsewhere = 0.05;   // likelihood of an end that lies off, relative to one that fits
constexpr double kHidden = 0.3;       // and of one that something would have to hide now
constexpr double kOneSurfaceM = 0.3;  // between neighbouring ends
constexpr double kStraight = 0.985;   // cosine of 10°
constexpr double kSmallProduct = 1e-200;
constexpr double kAcrossM = 0.02;  // deviation of an end across its surface

/// A scan, asked for the surface that it sees in a direction.
class SeenSurfaces {
 public:
  SeenSurfaces(const Scan& scan, std::span<const RayInRobot> rays, double claimed_m)
      : scan_{scan},
        rays_{rays},
        laser_{rays.front().origin.cast<double>()},
        across_m2_{kAcrossM * kAcrossM + kOffShare * kOffShare * claimed_m * claimed_m} {
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const double bearing_rad = scan.robot_from_laser.theta + scan.bearing_rad(i);
      const bool has_end = scan.beams[i].kind == BeamKind::kRange;
      directions_.push_back(has_end ? Point2{(rays[i].end - rays[i].origin).cast<double>()}
                                    : Point2{std::cos(bearing_rad), std::sin(bearing_rad)});
    }
  }

  /// Likelihood of an end of an earlier scan, given where it would lie now, robot frame, beside that of one that fits;
  /// 1 where the scan says nothing about it. It is looked for from beam `near` on.
  [[nodiscard]] double likelihood(const Point2& end, std::size_t near) const {
    const Point2 arm = end - laser_;
    const std::size_t beam = beam_before(arm, near);
    if (beam + 1 >= rays_.size()) return 1.0;
    const bool is_seen = scan_.beams[beam].kind == BeamKind::kRange && scan_.beams[beam + 1].kind == BeamKind::kRange;
    if (!is_seen) return 1.0;
    const Point2 a = rays_[beam].end.cast<double>();
    const Point2 b = rays_[beam + 1].end.cast<double>();
    const double range_m = arm.norm();
    const double seen_m = std::max(scan_.beams[beam].range_m, scan_.beams[beam + 1].range_m);
    const Point2 along = b - a;
    const double length_m = along.norm();
    const bool is_short = length_m < kOneSurfaceM + 2.0 * range_m * scan_.bearing_step_rad;
    const double off_m = length_m > 0.0 && (is_short || is_straight(beam))
                             ? std::abs(along.x() * (end - a).y() - along.y() * (end - a).x()) / length_m
                             : std::min((end - a).norm(), (end - b).norm());
    const double deviations2 = off_m * off_m / (across_m2_ + kOffRad * kOffRad * range_m * range_m);
    if (range_m > seen_m + 0.1 && deviations2 > 9.0) return kHidden;
    return kElsewhere + (1.0 - kElsewhere) * std::exp(-0.5 * deviations2);
  }

 private:
  /// The beam on the right of `arm` or along it, looked for from beam `near` on; where none is, the number of beams.
  [[nodiscard]] std::size_t beam_before(const Point2& arm, std::size_t near) const {
    const auto is_left_of = [&](std::size_t i) {
      return directions_[i].x() * arm.y() - directions_[i].y() * arm.x() >= 0.0;
    };
    std::size_t beam = std::min(near, directions_.size() - 1);
    while (beam + 1 < directions_.size() && is_left_of(beam + 1)) ++beam;
    while (!is_left_of(beam)) {
      if (beam == 0) return directions_.size();
      --beam;
    }
    return beam;
  }

  /// From this beam to the next a wall goes on that is seen at a slant: so do the ends before, or those after.
  [[nodiscard]] bool is_straight(std::size_t beam) const {
    const auto end = [this](std::size_t i) { return Point2{rays_[i].end.cast<double>()}; };
    const auto is_range = [this](std::size_t i) { return i < rays_.size() && scan_.beams[i].kind == BeamKind::kRange; };
    const Point2 along = (end(beam + 1) - end(beam)).normalized();
    const bool as_before =
        beam > 0 && is_range(beam - 1) && along.dot((end(beam) - end(beam - 1)).normalized()) > kStraight;
    return as_before || (is_range(beam + 2) && along.dot((end(beam + 2) - end(beam + 1)).normalized()) > kStraight);
  }

  const Scan& scan_;
  std::span<const RayInRobot> rays_;
  Point2 laser_;                    // robot frame
  std::vector<Point2> directions_;  // of the beams, robot frame
  double across_m2_;                // variance of an end across its surface, beside what a turn makes of it
};

}  // namespace

void Standstill::keep(const Scan& scan, std::span<const RayInRobot> rays) {
  kept_.clear();
  for (std::size_t i = 0; i < rays.size(); ++i) kept_.push_back({scan.beams[i], rays[i]});
  first_bearing_rad_ = scan.first_bearing_rad;
  bearing_step_rad_ = scan.bearing_step_rad;
}

bool Standstill::is_same(const Scan& scan) const {
  if (kept_.size() != scan.beams.size() || scan.first_bearing_rad != first_bearing_rad_ ||
      scan.bearing_step_rad != bearing_step_rad_)
    return false;
  const double deviation_m = std::sqrt(2.0) * scan.range_deviation_m;
  std::size_t compared = 0;
  std::size_t same = 0;
  std::size_t repeated = 0;
  double chi2 = 0.0;
  for (std::size_t i = 0; i < kept_.size(); ++i) {
    const bool has_range = scan.beams[i].kind == BeamKind::kRange;
    const bool had_range = kept_[i].beam.kind == BeamKind::kRange;
    if (!has_range && !had_range) continue;
    ++compared;
    if (!has_range || !had_range) continue;
    const double off = static_cast<double>(scan.beams[i].range_m - kept_[i].beam.range_m) / deviation_m;
    if (std::abs(off) > kDeviations) continue;
    ++same;
    repeated += off == 0.0 ? 1 : 0;
    chi2 += off * off;
  }
  return compared >= kFewestBeams && repeated < compared &&
         static_cast<double>(same) >= kLeastShareSame * static_cast<double>(compared) &&
         chi2 < kMostSameChi2 * static_cast<double>(same);
}

double Standstill::log_odds(const Scan& scan, std::span<const RayInRobot> rays, const Pose2& claimed,
                            double enough) const {
  const SeenSurfaces seen{scan, rays, claimed.position().norm()};
  const auto likelihood = [&](const Pose2& kept_from_robot) {
    const PointsInMap robot_from_kept{inverse(kept_from_robot)};
    double log_of_all = 0.0;
    double of_some = 1.0;  // a logarithm for many factors, before they underflow
    for (std::size_t i = 0; i < kept_.size(); ++i) {
      if (kept_[i].beam.kind != BeamKind::kRange) continue;
      of_some *= seen.likelihood(robot_from_kept(kept_[i].ray.end), i);
      if (of_some > kSmallProduct) continue;
      log_of_all += std::log(of_some);
      of_some = 1.0;
    }
    return (log_of_all + std::log(of_some)) / kAlikeBeams;
  };
  const double stands = likelihood({});
  double moved = likelihood(claimed);
  for (const double share : kShares) {
    for (const double turn_rad : kTurnsRad) {
      if (stands - moved <= enough) return stands - moved;
      moved =
          std::max(moved, likelihood({share * claimed.x, share * claimed.y, wrapped_angle(claimed.theta + turn_rad)}));
    }
  }
  return stands - moved;
}

}  // namespace deltamap::localization::odometer
