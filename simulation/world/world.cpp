// SPDX-License-Identifier: Apache-2.0
#include "simulation/world/world.hpp"

#include <algorithm>
#include <limits>

namespace deltamap::simulation {

const Object* World::find(int id) const {
  const auto found =
      std::find_if(objects.begin(), objects.end(), [&](const Object& object) { return object.id == id; });
  return found == objects.end() ? nullptr : &*found;
}

World World::with(const Object& object) const {
  World changed = without(object.id);
  changed.objects.push_back(object);
  return changed;
}

World World::without(int id) const {
  World changed;
  std::copy_if(objects.begin(), objects.end(), std::back_inserter(changed.objects),
               [&](const Object& object) { return object.id != id; });
  return changed;
}

int World::largest_id() const {
  int largest = 0;
  for (const Object& object : objects) largest = std::max(largest, object.id);
  return largest;
}

Bounds bounds_of(const World& world) {
  constexpr double kFar = std::numeric_limits<double>::infinity();
  Bounds bounds{{kFar, kFar}, {-kFar, -kFar}};
  const auto include = [&](const Point2& point) {
    bounds.low = bounds.low.cwiseMin(point);
    bounds.high = bounds.high.cwiseMax(point);
  };
  for (const Object& object : world.objects) {
    if (const auto* circle = std::get_if<Circle>(&object.shape)) {
      include(circle->centre - Point2::Constant(circle->radius_m));
      include(circle->centre + Point2::Constant(circle->radius_m));
    }
    for (const Segment& segment : segments_of(object.shape)) {
      include(segment.from);
      include(segment.to);
    }
  }
  return bounds.low.x() <= bounds.high.x() ? bounds : Bounds{};
}

}  // namespace deltamap::simulation
