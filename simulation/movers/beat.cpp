// SPDX-License-Identifier: Apache-2.0
#include "simulation/movers/beat.hpp"

#include <cassert>
#include <utility>

namespace deltamap::simulation {

Beat::Beat(std::vector<Point2> corners, bool closed) : corners_{std::move(corners)}, closed_{closed} {
  assert(corners_.size() >= 2 && "a path has at least two corners");
}

void Beat::reach() {
  const std::size_t last = corners_.size() - 1;
  if (!closed_ && aim_ == (backwards_ ? 0 : last)) {
    turn_back();
  } else {
    aim_ = beyond(aim_);
  }
}

void Beat::turn_back() {
  backwards_ = !backwards_;
  aim_ = beyond(aim_);
}

void Beat::begin_anew() {
  aim_ = 0;
  backwards_ = false;
}

std::size_t Beat::beyond(std::size_t corner) const {
  const std::size_t count = corners_.size();
  return (corner + (backwards_ ? count - 1 : 1)) % count;
}

}  // namespace deltamap::simulation
