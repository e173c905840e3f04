// SPDX-License-Identifier: Apache-2.0
#include "simulation/world/bodies.hpp"

#include <cassert>
#include <cmath>

namespace deltamap::simulation {
namespace {

constexpr double kBead_m = 0.02;  // radius: half of a leaf's thickness
constexpr double kBeadsApart_m = 0.1;

}  // namespace

void Bodies::add_person(const Circle& person) {
  assert(truck_edges_ == edges_.size() && "leaves come last");
  people_.push_back(person);
  obstacles_.push_back(person);
  ++walkers_;
}

void Bodies::add_truck(const Box& truck) {
  assert(truck_edges_ == edges_.size() && "leaves come last");
  for (const Segment& face : faces(truck)) edges_.push_back(face);
  truck_edges_ = edges_.size();
  for (const Circle& part : cover_of(truck)) obstacles_.push_back(part);
  walkers_ = obstacles_.size();
}

void Bodies::add_leaf(const Segment& leaf) {
  edges_.push_back(leaf);
  for (const Circle& bead : beads_of(leaf)) obstacles_.push_back(bead);
}

std::vector<Circle> cover_of(const Box& truck) {
  const double third_m = truck.width_m / 3.0;
  const double radius_m = std::hypot(0.5 * third_m, 0.5 * truck.height_m);
  std::vector<Circle> cover;
  for (const double along_m : {-third_m, 0.0, third_m}) {
    cover.push_back({truck.map_from_box() * Point2{along_m, 0.0}, radius_m});
  }
  return cover;
}

std::vector<Circle> beads_of(const Segment& leaf) {
  const Point2 along = leaf.to - leaf.from;
  const int pieces = 1 + static_cast<int>(along.norm() / kBeadsApart_m);
  std::vector<Circle> beads;
  for (int i = 0; i <= pieces; ++i) beads.push_back({leaf.from + (static_cast<double>(i) / pieces) * along, kBead_m});
  return beads;
}

}  // namespace deltamap::simulation
