// SPDX-License-Identifier: Apache-2.0
// A scan that is kept for a set S(k).
#pragma once

#include <memory>

#include "core/messages.hpp"

namespace deltamap::mapping::scan_set {

/// A copy without its map: it outlives the map that its pose was computed on.
[[nodiscard]] inline std::shared_ptr<const TrackedScan> kept_scan(const TrackedScan& tracked) {
  auto kept = std::make_shared<TrackedScan>(tracked);
  kept->estimate.map.reset();
  return kept;
}

}  // namespace deltamap::mapping::scan_set
