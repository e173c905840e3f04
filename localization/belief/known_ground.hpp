// SPDX-License-Identifier: Apache-2.0
// Does anything hold the pose that the map had when the run began? In a part of the building that it leaves out the
// robot draws as it goes, and each pose there rests on what was drawn by the pose before: scans fit, however far all of
// it has drifted. Such a pose says nothing of the ground that was known before.
#pragma once

#include <span>

#include "core/grid/occupancy_grid.hpp"
#include "localization/belief/beam_check.hpp"

namespace deltamap::localization::belief {

class KnownGround {
 public:
  /// `begun_with`: the map at the begin of the run; its tiles are shared.
  explicit KnownGround(const OccupancyGrid& begun_with) : begun_with_{begun_with} {}

  /// A scan that was held against the map, and the way since the one before.
  void observe(std::span<const CheckedBeam> beams, const GridGeometry& map, double driven_m);
  /// The pose was given or found: known ground has told of it.
  void start() { is_left_ = false, without_m_ = held_m_ = out_of_view_m_ = 0.0; }

  /// The pose rests on what this run has drawn where the map knew nothing.
  [[nodiscard]] bool is_left() const { return is_left_; }

 private:
  OccupancyGrid begun_with_;
  bool is_left_ = false;
  double without_m_ = 0.0;      // driven since known ground has held the pose
  double held_m_ = 0.0;         // driven while it does
  double out_of_view_m_ = 0.0;  // driven while nothing that was drawn is in view
};

}  // namespace deltamap::localization::belief
