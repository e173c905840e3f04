// SPDX-License-Identifier: Apache-2.0
// Where a ray first meets the world. Surfaces lie in buckets of a uniform grid, so that a ray asks only those near it.
// Built anew when the world changes; people, who move all the time, are handed in with each ray.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/occupancy_grid.hpp"
#include "simulation/world.hpp"

namespace deltamap::simulation {

inline constexpr int kPersonId = -1;  ///< what a ray has hit where it has hit none of the world's objects

struct RayHit {
  double range_m = 0.0;
  int object = 0;  ///< id
  int face = 0;    ///< index of the segment in segments_of(shape); 0 for a circle
};

class RayCaster {
 public:
  explicit RayCaster(const World& world);

  /// The first surface from `from` towards `bearing_rad` (map frame) no farther than max_range_m.
  [[nodiscard]] std::optional<RayHit> cast(const Point2& from, double bearing_rad, double max_range_m,
                                           std::span<const Circle> people = {}) const;

  struct Nearest {
    double distance_m = 0.0;
    Point2 direction{0.0, 0.0};  ///< unit vector from the point to the surface; zero on it
  };
  /// The surface nearest to a point, if one is nearer than within_m.
  [[nodiscard]] std::optional<Nearest> nearest_surface(const Point2& point, double within_m) const;

 private:
  struct Surface {
    Segment segment;        // a circle stands as its centre and...
    double radius_m = 0.0;  // ...its radius, > 0
    int object = 0;
    int face = 0;
  };
  void enter(std::size_t surface);
  [[nodiscard]] std::span<const std::uint32_t> bucket(Cell cell) const;

  GridGeometry buckets_;
  std::vector<Surface> surfaces_;
  std::vector<std::vector<std::uint32_t>> contents_;
};

}  // namespace deltamap::simulation
