// SPDX-License-Identifier: Apache-2.0
// What the scans of the last metres have seen: surfels, pieces of surface of the size of a cell, in a ring of cells
// that moves along with the robot. No map of the building is asked.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "core/geometry/pose2.hpp"
#include "core/time.hpp"
#include "localization/odometer/line_points.hpp"

namespace deltamap::localization::odometer {

/// A piece of surface.
struct Surfel {
  Eigen::Vector2f at{0.0F, 0.0F};      ///< m, from the middle of its cell: floats stay fine far from the origin
  Eigen::Vector2f normal{0.0F, 0.0F};  ///< towards whoever saw it, unit vector
  std::int32_t column = 0;             ///< its cell
  std::int32_t row = 0;
  float seen = 0.0F;    ///< in so many scans, kMostSeen at most; 0: there is none
  float way_m = 0.0F;   ///< driven when it was seen last
  float born_s = 0.0F;  ///< when it was seen first
};

/// A surfel near a point.
struct NearSurfel {
  const Surfel* surfel = nullptr;
  float off_m = 0.0F;  ///< of the point, along the surfel's normal
};

class SurfelMap {
 public:
  SurfelMap();

  /// The robot has come so far since the start, and so much time has passed: surfels that were seen more than
  /// kRememberedM ago are forgotten.
  void go_on(double way_m, double time_s);
  /// The points that lie on lines, as seen from a pose in the map's frame.
  void insert(std::span<const LinePoint> points, const Pose2& map_from_robot);
  /// The nearest surfel, not farther than `reach_m`, whose normal is within 45° of the
  /// point's, where that has one. `at` and `normal`: in the map's frame.
  [[nodiscard]] NearSurfel near(const Point2& at, const Eigen::Vector2f& normal, float reach_m) const;
  /// It was seen first less than a second ago: whoever walks leaves only such ones.
  [[nodiscard]] bool is_young(const Surfel& surfel) const { return time_s_ - surfel.born_s < kYoungS; }
  /// Forgets what was inserted since then.
  void forget_since(double time_s);

 private:
  static constexpr int kSide = 128;  // cells
  static constexpr int kEach = 2;    // surfels of a cell: both faces of a thin wall, or of a corner
  static constexpr float kYoungS = 1.0F;

  [[nodiscard]] static std::size_t slot_of(std::int32_t column, std::int32_t row) {
    const auto at = [](std::int32_t cell) { return static_cast<std::size_t>(cell & (kSide - 1)); };
    return (at(row) * kSide + at(column)) * kEach;
  }
  [[nodiscard]] bool is_alive(const Surfel& surfel) const;

  std::vector<Surfel> surfels_;
  float way_m_ = 0.0F;
  float time_s_ = 0.0F;
};

}  // namespace deltamap::localization::odometer
