// SPDX-License-Identifier: Apache-2.0
// The things that stand in a simulated world. Walls, panes and posts stay; containers come, go and are pushed about.
#pragma once

#include <cstdint>
#include <vector>

#include "simulation/world/shapes.hpp"

namespace deltamap::simulation {

enum class ObjectKind : std::uint8_t { kWall, kContainer, kPost, kDoor };

/// What a beam meets (surface_optics.hpp).
enum class Material : std::uint8_t { kSolid, kGlass, kWrap };

struct Object {
  int id = 0;  ///< unique in the world; a container that comes anew has a new one
  ObjectKind kind = ObjectKind::kWall;
  Shape shape;
  Material material = Material::kSolid;
  bool is_drawn = true;  ///< in the map of the start
};

struct Bounds {
  Point2 low{0.0, 0.0};
  Point2 high{0.0, 0.0};
};

struct World {
  std::vector<Object> objects;

  [[nodiscard]] const Object* find(int id) const;
  /// The world with the object in it, in place of one that had its id.
  [[nodiscard]] World with(const Object& object) const;
  [[nodiscard]] World without(int id) const;
  [[nodiscard]] int largest_id() const;
};

/// The smallest upright rectangle around everything; empty at the origin for an empty world.
[[nodiscard]] Bounds bounds_of(const World& world);

}  // namespace deltamap::simulation
