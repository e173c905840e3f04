// SPDX-License-Identifier: Apache-2.0
// Watches one change from the robot's true poses: how long each of its faces was seen and which cells of the map the
// beams touched there.
#pragma once

#include <array>
#include <optional>
#include <unordered_set>
#include <vector>

#include "core/grid/occupancy_grid.hpp"
#include "simulation/world/ray_caster.hpp"

namespace deltamap::simulation::score {

/// A beam of the true world.
struct TrueBeam {
  Point2 from{0.0, 0.0};
  double bearing_rad = 0.0;
  double range_m = 0.0;  ///< to the hit, or as far as the robot sees
  std::optional<RayHit> hit;
};

class Witness {
 public:
  /// Of a container that has come: beams that hit it see it.
  static Witness of_appearance(int id, const Box& box, const GridGeometry& geometry);
  /// Of a container that has gone: beams see that it is gone where they pass through cells that its surface occupied.
  static Witness of_disappearance(const Box& box, const GridGeometry& geometry, std::unordered_set<std::size_t> former);

  void look(const TrueBeam& beam);
  /// The pose from which the last beams came stood for so long; a face that fewer than `face_beams` of them showed was
  /// not seen.
  void end_look(double seconds, int face_beams);

  [[nodiscard]] double longest_seen_s() const;
  /// Of each face, as faces(box) has them.
  [[nodiscard]] const std::array<double, 4>& faces_seen_s() const { return seen_s_; }
  /// Cells touched, by index in the map.
  [[nodiscard]] const std::unordered_set<std::size_t>& touched() const { return touched_; }

 private:
  Witness(int id, const Box& box, const GridGeometry& geometry, std::unordered_set<std::size_t> former);
  void look_through(const TrueBeam& beam);

  int id_;
  Box box_;
  std::array<Segment, 4> faces_;
  GridGeometry geometry_;
  std::unordered_set<std::size_t> former_;
  std::array<int, 4> beams_now_{};
  std::array<double, 4> seen_s_{};
  std::unordered_set<std::size_t> touched_;
};

}  // namespace deltamap::simulation::score
