// SPDX-License-Identifier: Apache-2.0
// Bays as other programs read them: a line of bays.jsonl a change of state, and the list of all.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "daemon/outputs/bays_board.hpp"
#include "daemon/outputs/things_board.hpp"
#include "mapping/bays/bays.hpp"

namespace deltamap::daemon {

/// Ids of those that stand in the bay, by their outlines.
[[nodiscard]] std::vector<std::uint32_t> things_in(const mapping::bays::Bay& bay,
                                                   const std::vector<mapping::things::Thing>& things);

/// One line of bays.jsonl with its line end.
[[nodiscard]] std::string json_line(const mapping::bays::BayEvent& event,
                                    const std::vector<mapping::things::Thing>& things);

/// {"ok":true,"time":…,"bays":[…]}; ages are those at `now`.
[[nodiscard]] std::string json_of(const BayList& list, const ThingList& things, Timestamp now);

/// "bay B4: full, was empty; 0.93 of its floor is taken"
[[nodiscard]] std::string words_of(const mapping::bays::BayEvent& event);

}  // namespace deltamap::daemon
