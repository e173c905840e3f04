// SPDX-License-Identifier: Apache-2.0
// The override rule, for comparison: every keyframe writes its beams' ends occupied and what they passed free, at once
// and whatever was there. Follows everything, and everybody who walks by.
#pragma once

#include <optional>

#include "core/messages.hpp"
#include "mapping/scan_set/keyframe_choice.hpp"

namespace deltamap::experiments {

class OverrideMap {
 public:
  explicit OverrideMap(OccupancyGrid first) : map_{std::move(first)} {}

  /// Every tracked scan, at the estimated pose; keyframes as the evidence method chooses them.
  void observe(const TrackedScan& tracked);
  [[nodiscard]] const OccupancyGrid& map() const { return map_; }

 private:
  [[nodiscard]] bool is_keyframe(const TrackedScan& tracked) const;
  void set(Cell cell, CellState state);

  OccupancyGrid map_;
  std::optional<mapping::scan_set::ScanPlace> last_;
};

}  // namespace deltamap::experiments
