// SPDX-License-Identifier: Apache-2.0
// The corners that someone walks, to and fro or round and round.
#pragma once

#include <vector>

#include "core/geometry/pose2.hpp"

namespace deltamap::simulation {

class Beat {
 public:
  /// Of at least two corners; `closed`: from the last on to the first, else back the way one came. Begins at the first.
  Beat(std::vector<Point2> corners, bool closed);

  /// The corner that is walked to.
  [[nodiscard]] const Point2& aim() const { return corners_[aim_]; }
  [[nodiscard]] std::size_t corners() const { return corners_.size(); }
  [[nodiscard]] bool aims_at_first() const { return aim_ == 0; }
  /// It is reached: on to the next.
  void reach();
  /// Back where one came from.
  void turn_back();
  /// From wherever one is, straight to that corner of all but the one that is walked to, below corners() - 1.
  void head_for_other(std::size_t corner) { aim_ = corner + (corner >= aim_ ? 1 : 0); }
  /// From outside of the corners to the first.
  void begin_anew();

 private:
  [[nodiscard]] std::size_t beyond(std::size_t corner) const;

  std::vector<Point2> corners_;
  bool closed_;
  std::size_t aim_ = 1;
  bool backwards_ = false;
};

}  // namespace deltamap::simulation
