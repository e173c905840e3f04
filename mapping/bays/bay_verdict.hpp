// SPDX-License-Identifier: Apache-2.0
// What the floor of a bay shows: a state, nothing that is enough for one, or what contradicts the state so far.
#pragma once

#include <optional>

#include "mapping/bays/bay_floor.hpp"

namespace deltamap::mapping::bays {

/// Nothing: too little of the floor is known. `so_far` is left only where the floor clearly shows another.
[[nodiscard]] std::optional<BayState> shown_state(const FloorCounts& counts, BayState so_far);
/// Too little for another state, and too much against this one.
[[nodiscard]] bool contradicts(const FloorCounts& counts, BayState state);
/// How many of the floor's cells must be known to tell it.
[[nodiscard]] int least_known(const FloorCounts& counts, BayState state);
/// Of what is known of the floor, [0, 1].
[[nodiscard]] double taken_share(const FloorCounts& counts);
/// Share of the floor that the judgement rests on, [0, 1]: what lies behind a face was not seen itself.
[[nodiscard]] double confidence_in(const FloorCounts& counts);

}  // namespace deltamap::mapping::bays
