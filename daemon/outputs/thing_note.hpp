// SPDX-License-Identifier: Apache-2.0
// Things as other programs read them: a line of things.jsonl an event, and the list of all.
#pragma once

#include <string>

#include "daemon/outputs/things_board.hpp"
#include "mapping/things/things.hpp"

namespace deltamap::daemon {

/// One line of things.jsonl with its line end.
[[nodiscard]] std::string json_line(const mapping::things::ThingEvent& event);

/// {"ok":true,"things":[…],"corrections":…,"forgotten":…}
[[nodiscard]] std::string json_of(const ThingList& list);

}  // namespace deltamap::daemon
