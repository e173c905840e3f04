// SPDX-License-Identifier: Apache-2.0
// Where a ray first meets the world. Surfaces lie in buckets of a uniform grid, so that a ray asks only those near it.
// Built anew when the world changes; people, fork-lifts and doors, which move all the time, are handed in with each
// ray.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/grid/occupancy_grid.hpp"
#include "simulation/world/bodies.hpp"
#include "simulation/world/world.hpp"

namespace deltamap::simulation {

inline constexpr int kMoverId = -1;  ///< what a ray has hit where it has hit none of the world's objects

/// Objects narrower than this may stand between the middle and the rim of a laser's beam.
inline constexpr double kThin_m = 0.15;

struct RayHit {
  double range_m = 0.0;
  int object = 0;  ///< id
  int face = 0;    ///< index of the segment in segments_of(shape); 0 for a circle
  Material material = Material::kSolid;
  double incidence_cosine = 1.0;  ///< of the angle to the perpendicular; of a straight surface that is not solid
  bool is_thin = false;           ///< of an object narrower than kThin_m
};

class RayCaster {
 public:
  explicit RayCaster(const World& world);

  /// The first surface from `from` towards `bearing_rad` (map frame) no farther than max_range_m.
  [[nodiscard]] std::optional<RayHit> cast(const Point2& from, double bearing_rad, double max_range_m,
                                           const MovingSurfaces& moving = {}) const;

  /// Whether any object is narrower than kThin_m.
  [[nodiscard]] bool has_thin_objects() const { return has_thin_objects_; }

  struct Nearest {
    double distance_m = 0.0;
    int object = 0;              ///< id
    Point2 direction{0.0, 0.0};  ///< unit vector from the point to the surface; zero on it
  };
  /// The surface nearest to a point, if one is nearer than within_m.
  [[nodiscard]] std::optional<Nearest> nearest_surface(const Point2& point, double within_m) const;

 private:
  struct Surface {
    Segment segment;        // a circle stands as its centre and...
    double radius_m = 0.0;  // ...its radius, > 0
    int object = 0;
    std::uint16_t face = 0;
    Material material = Material::kSolid;
    bool is_thin = false;
  };
  [[nodiscard]] static RayHit hit_on(const Surface& surface, double range_m, const Point2& direction);
  void enter(std::size_t surface);
  [[nodiscard]] std::span<const std::uint32_t> bucket(Cell cell) const;

  GridGeometry buckets_;
  std::vector<Surface> surfaces_;
  std::vector<std::vector<std::uint32_t>> contents_;
  bool has_thin_objects_ = false;
};

}  // namespace deltamap::simulation
