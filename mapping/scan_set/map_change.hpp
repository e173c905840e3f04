// SPDX-License-Identifier: Apache-2.0
// What a map update answers to a set S(k): the changed cells, or why it refuses them. Both methods answer so.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "core/messages.hpp"

namespace deltamap::mapping::scan_set {

enum class Refusal : std::uint8_t {
  kNone,
  kTooFewScans,    ///< nothing to align
  kNoAlignment,    ///< the scans do not agree with each other
  kNoMerge,        ///< no rigid motion brings the local map onto the map
  kLowAcceptance,  ///< Eq. 11 below its threshold
  kImplausible,    ///< the merge contradicts the localizer's pose by more than its covariance allows (χ²)
  kNothingChanged,
  kPoseInDoubt,    ///< the set rests on a pose that has proven wrong, or may have been (write gate)
  kSetByOperator,  ///< all that it would change has been set by an operator a moment ago
  kZoned           ///< all that it would change lies in zones that are never written
};
[[nodiscard]] std::string_view name_of(Refusal refusal);
/// Something may have changed, and the map does not say so; false where the map was found right, and where an operator
/// or a zone forbids the change.
[[nodiscard]] bool leaves_map_stale(Refusal refusal);

struct MapUpdate {
  Refusal refusal = Refusal::kNone;
  std::vector<CellChange> changes;  ///< empty where refused
  double acceptance = 0.0;          ///< Eq. 11 of local map and map

  [[nodiscard]] bool accepted() const { return refusal == Refusal::kNone; }
};

}  // namespace deltamap::mapping::scan_set
