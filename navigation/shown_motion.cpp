// SPDX-License-Identifier: Apache-2.0
#include "navigation/shown_motion.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "core/geometry/angle.hpp"
#include "navigation/fan.hpp"

namespace deltamap::navigation {
namespace {

constexpr double kClearlyElsewhere = 2.0;  // times what is the same
// Neighbours nearer to each other than this lie on one surface, seen at a slant.
constexpr double kOneSurfaceM = 0.3;
constexpr double kOneSurfacePerM = 0.1;
constexpr std::array<double, 5> kAsTold{1.0, 0.9, 1.1, 0.75, 1.25};
constexpr int kTurnSteps = 3;  // to each side
constexpr std::array<double, 4> kOtherwise{0.0, 0.25, -0.5, -1.0};
constexpr std::array<double, 3> kTurnedOnMountRad{radians(90.0), radians(180.0), radians(-90.0)};
constexpr std::array<double, 4> kAskewOnMountRad{radians(45.0), radians(135.0), radians(-135.0), radians(-45.0)};

struct SeenEnd {
  Point2 in_laser;
  double range_m;
};

/// What a scan shows in a direction, compared with a range.
class Profile {
 public:
  explicit Profile(const Scan& scan) : scan_{scan} {}

  /// How far a range is from what the beams around this bearing have seen; nothing where they have seen nothing.
  [[nodiscard]] std::optional<double> off_m(const SeenEnd& point) const {
    const auto towards = beam_towards(scan_, point.in_laser);
    if (!towards) return std::nullopt;
    const auto middle = static_cast<std::ptrdiff_t>(*towards);
    const auto count = static_cast<std::ptrdiff_t>(scan_.beams.size());
    std::optional<double> off;
    const auto look = [&](double range_m) {
      const double here = std::abs(range_m - point.range_m);
      off = off ? std::min(*off, here) : here;
    };
    for (std::ptrdiff_t i = std::max<std::ptrdiff_t>(0, middle - 1); i <= std::min(count - 1, middle + 1); ++i) {
      const Beam& beam = scan_.beams[static_cast<std::size_t>(i)];
      if (beam.kind != BeamKind::kRange) continue;
      look(static_cast<double>(beam.range_m));
      if (i == 0) continue;
      const Beam& other = scan_.beams[static_cast<std::size_t>(i - 1)];
      const double low = std::min(beam.range_m, other.range_m);
      const double high = std::max(beam.range_m, other.range_m);
      const bool between =
          low < point.range_m && point.range_m < high && high - low < kOneSurfaceM + kOneSurfacePerM * low;
      if (other.kind == BeamKind::kRange && between) look(point.range_m);
    }
    return off;
  }

 private:
  const Scan& scan_;
};

double same_within_m(const Likeness& likeness, double range_m) {
  return likeness.same_m + likeness.same_per_m * range_m;
}

/// That share of a motion, along its arc.
Pose2 share_of(const Pose2& motion, double share) {
  const double turn_rad = share * motion.theta;
  const double chord_rad = 0.5 * turn_rad;
  const double full_rad = 0.5 * motion.theta;
  const double along_m = std::hypot(motion.x, motion.y);
  const double direction_rad = std::atan2(motion.y, motion.x) - full_rad + chord_rad;
  return {share * along_m * std::cos(direction_rad), share * along_m * std::sin(direction_rad), turn_rad};
}

/// Ends of the first scan, from where the laser is after that motion.
class Ends {
 public:
  explicit Ends(const Scan& scan) : mount_{scan.robot_from_laser} {
    for (std::size_t i = 0; i < scan.beams.size(); ++i) {
      if (scan.beams[i].kind != BeamKind::kRange) continue;
      const double range_m = static_cast<double>(scan.beams[i].range_m);
      const double bearing = scan.bearing_rad(i);
      in_laser_.emplace_back(range_m * std::cos(bearing), range_m * std::sin(bearing));
    }
  }
  [[nodiscard]] std::size_t size() const { return in_laser_.size(); }
  [[nodiscard]] SeenEnd after(std::size_t end, const Pose2& laser_after_from_before) const {
    const Point2 point = laser_after_from_before * in_laser_[end];
    return {point, point.norm()};
  }
  /// `turned_rad`: of the laser on its mount, against what that says.
  [[nodiscard]] Pose2 of_laser(const Pose2& robot_before_from_after, double turned_rad = 0.0) const {
    const Pose2 robot_from_laser = mount_ * Pose2{0.0, 0.0, turned_rad};
    return inverse(inverse(robot_from_laser) * robot_before_from_after * robot_from_laser);
  }

 private:
  Pose2 mount_;
  std::vector<Point2> in_laser_;
};

}  // namespace

ShownMotion shown_motion(const Scan& before, const Scan& after, const Pose2& robot_before_from_after,
                         const Likeness& likeness) {
  const Ends ends{before};
  const Profile then{before};
  const Profile now{after};
  std::vector<std::size_t> asked;
  const Pose2 told = ends.of_laser(robot_before_from_after);
  for (std::size_t i = 0; i < ends.size(); ++i) {
    const SeenEnd moved = ends.after(i, told);
    const auto off_m = then.off_m(moved);
    if (off_m && *off_m > kClearlyElsewhere * same_within_m(likeness, moved.range_m)) asked.push_back(i);
  }
  ShownMotion shown{.asked = static_cast<int>(asked.size())};
  if (asked.empty()) return shown;
  const auto share_seen = [&](const Pose2& moved) {
    const auto seen = std::count_if(asked.begin(), asked.end(), [&](std::size_t end) {
      const SeenEnd point = ends.after(end, moved);
      const auto off_m = now.off_m(point);
      return off_m && *off_m <= same_within_m(likeness, point.range_m);
    });
    return static_cast<double>(seen) / static_cast<double>(asked.size());
  };
  for (const double share : kAsTold) {
    for (int step = -kTurnSteps; step <= kTurnSteps; ++step) {
      const double turned_rad = likeness.turned_more_rad * step / kTurnSteps;
      const Pose2 motion = share_of(robot_before_from_after, share) * Pose2{0.0, 0.0, turned_rad};
      shown.as_told = std::max(shown.as_told, share_seen(ends.of_laser(motion)));
    }
  }
  const auto otherwise = [&](const Pose2& moved) { shown.otherwise = std::max(shown.otherwise, share_seen(moved)); };
  for (const double share : kOtherwise) otherwise(ends.of_laser(share_of(robot_before_from_after, share)));
  for (const double turned_rad : kTurnedOnMountRad) otherwise(ends.of_laser(robot_before_from_after, turned_rad));
  for (const double turned_rad : kAskewOnMountRad)
    shown.askew = std::max(shown.askew, share_seen(ends.of_laser(robot_before_from_after, turned_rad)));
  return shown;
}

}  // namespace deltamap::navigation
