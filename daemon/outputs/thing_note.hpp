// SPDX-License-Identifier: Apache-2.0
// Things as other programs read them: a line of things.jsonl an event, and the list of all.
#pragma once

#include <span>
#include <string>

#include "mapping/things/things.hpp"

namespace deltamap::daemon {

/// One line of things.jsonl with its line end.
[[nodiscard]] std::string json_line(const mapping::things::ThingEvent& event);

/// A thing as an object of JSON, as it stands in its line.
[[nodiscard]] std::string json_of(const mapping::things::Thing& thing);

/// {"things":[…],"corrections":…,"forgotten":…}
[[nodiscard]] std::string json_of(std::span<const mapping::things::Thing> things, std::uint64_t corrections,
                                  std::uint64_t forgotten);

}  // namespace deltamap::daemon
