// SPDX-License-Identifier: Apache-2.0
// What a map store tells of a revision or a refusal.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/geometry/pose2.hpp"
#include "core/grid/grid_patch.hpp"
#include "core/time.hpp"

namespace deltamap::mapping::store {

/// What a revision or a refusal is kept with.
struct RevisionNote {
  std::uint32_t phase = 0;  ///< number of the Δ-phase
  double acceptance = 0.0;  ///< Eq. 11
  std::string cause;        ///< method, "withdrawn", "undo of K", or the reason of the refusal
  /// Of the localizer's pose when the Δ-phase ended; nothing where no localizer had a part in it.
  std::optional<PoseCovariance> covariance{};
  /// Numbers of the revisions that are provisional from now on, oldest first; nothing: those that were before.
  std::optional<std::vector<std::uint32_t>> provisional{};
};

struct StoredRevision {
  std::uint32_t number = 0;  ///< k; a refusal has the number of the revision that stayed
  bool refused = false;
  Timestamp time;
  RevisionNote note;
  std::uint32_t occupied = 0;  ///< cells that became occupied
  std::uint32_t freed = 0;     ///< cells that became free
  std::uint32_t unknown = 0;   ///< cells that became unknown
  CellBox box;                 ///< of the changed cells
  std::string name{};          ///< given by a person; empty: none
};

}  // namespace deltamap::mapping::store
