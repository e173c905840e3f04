// SPDX-License-Identifier: Apache-2.0
// Thins out what a map store remembers: between two whole maps that no rule keeps one by one, the steps become one
// step. Every revision that remains can be restored, and what it changed is told from the one that remains before it.
#pragma once

#include <cstdint>

#include "core/grid/grid_geometry.hpp"
#include "core/time.hpp"
#include "mapping/store/database.hpp"
#include "mapping/store/retention.hpp"

namespace deltamap::mapping::store {

/// Thins out the oldest stretch that may be: at most 63 revisions, in one transaction. False where there is none, or
/// where it is damaged: what is left of it is for a recovery. Revisions from `first_provisional` on stay one by one; 0:
/// there are none.
/// `now` is Unix time. The clock may have jumped: a revision whose time lies in the future, or before that of an older
/// one, is as old as the next one whose time is credible. Throws StoreError.
bool thin_out(Database& database, std::int64_t map, const GridGeometry& geometry, const Retention& retention,
              std::uint32_t first_provisional, Timestamp now);

}  // namespace deltamap::mapping::store
