// SPDX-License-Identifier: Apache-2.0
#include "simulation/world/standing_room.hpp"

#include <algorithm>

namespace deltamap::simulation {
namespace {

constexpr double kNeighbourGap_m = 1e-3;  // containers of a block touch

}  // namespace

bool stands_free(const Box& box, int own_id, const World& world) {
  const Box body = grown(box, -kNeighbourGap_m);
  return std::none_of(world.objects.begin(), world.objects.end(),
                      [&](const Object& object) { return object.id != own_id && overlap(body, object.shape); });
}

bool keeps_away(const Box& box, const Circle& body, double margin_m) {
  return distance_between(body.centre, box) >= body.radius_m + margin_m;
}

bool keeps_away(const Box& box, std::span<const Circle> bodies, double margin_m) {
  return std::all_of(bodies.begin(), bodies.end(), [&](const Circle& body) { return keeps_away(box, body, margin_m); });
}

}  // namespace deltamap::simulation
