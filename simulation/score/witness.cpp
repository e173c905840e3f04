// SPDX-License-Identifier: Apache-2.0
#include "simulation/score/witness.hpp"

#include <algorithm>
#include <cmath>

#include "core/grid/grid_ray.hpp"

namespace deltamap::simulation::score {
namespace {

constexpr int kNobody = -1000;  // an id that no beam hits

/// Where along the beam it crosses a segment; none where it does not.
std::optional<double> crossing(const TrueBeam& beam, const Point2& direction, const Segment& segment) {
  const Point2 along = segment.to - segment.from;
  const double sine = direction.x() * along.y() - direction.y() * along.x();
  if (sine == 0.0) return std::nullopt;
  const Point2 start = segment.from - beam.from;
  const double range_m = (start.x() * along.y() - start.y() * along.x()) / sine;
  const double share = (start.x() * direction.y() - start.y() * direction.x()) / sine;
  if (range_m < 0.0 || share < 0.0 || share > 1.0) return std::nullopt;
  return range_m;
}

}  // namespace

Witness::Witness(int id, const Box& box, const GridGeometry& geometry, std::unordered_set<std::size_t> former)
    : id_{id}, box_{box}, faces_{faces(box)}, geometry_{geometry}, former_{std::move(former)} {}

Witness Witness::of_appearance(int id, const Box& box, const GridGeometry& geometry) { return {id, box, geometry, {}}; }

Witness Witness::of_disappearance(const Box& box, const GridGeometry& geometry,
                                  std::unordered_set<std::size_t> former) {
  return {kNobody, box, geometry, std::move(former)};
}

void Witness::look(const TrueBeam& beam) {
  if (id_ == kNobody) return look_through(beam);
  if (!beam.hit || beam.hit->object != id_) return;
  ++beams_now_[static_cast<std::size_t>(beam.hit->face)];
  const Point2 end = beam.from + beam.range_m * Point2{std::cos(beam.bearing_rad), std::sin(beam.bearing_rad)};
  const Cell cell = geometry_.cell_at(end);
  if (geometry_.contains(cell)) touched_.insert(geometry_.index_of(cell));
}

void Witness::look_through(const TrueBeam& beam) {
  const Point2 direction{std::cos(beam.bearing_rad), std::sin(beam.bearing_rad)};
  const Point2 to_box = box_.centre - beam.from;
  const double aside_m = std::abs(direction.x() * to_box.y() - direction.y() * to_box.x());
  if (aside_m > std::hypot(box_.width_m, box_.height_m) || to_box.dot(direction) < -box_.width_m - box_.height_m)
    return;

  const double reach_m = 2.0 * geometry_.resolution_m;  // before and behind the face
  const double clear_m = beam.range_m - reach_m;        // nothing is said about the cells at the hit
  for (std::size_t face = 0; face < faces_.size(); ++face) {
    const auto range_m = crossing(beam, direction, faces_[face]);
    if (!range_m || *range_m > clear_m) continue;
    bool shows = false;
    const Point2 begin = beam.from + std::max(0.0, *range_m - reach_m) * direction;
    const Point2 end = beam.from + std::min(clear_m, *range_m + reach_m) * direction;
    walk_ray(geometry_, begin, end, [&](Cell cell, double) {
      if (geometry_.contains(cell) && former_.contains(geometry_.index_of(cell))) {
        touched_.insert(geometry_.index_of(cell));
        shows = true;
      }
      return true;
    });
    if (shows) ++beams_now_[face];
  }
}

void Witness::end_look(double seconds, int face_beams) {
  for (std::size_t face = 0; face < beams_now_.size(); ++face) {
    if (beams_now_[face] >= face_beams) seen_s_[face] += seconds;
    beams_now_[face] = 0;
  }
}

double Witness::longest_seen_s() const { return *std::max_element(seen_s_.begin(), seen_s_.end()); }

}  // namespace deltamap::simulation::score
