// SPDX-License-Identifier: Apache-2.0
// The things that revisions tell of: those of a store, one after the other, and the next one of a run. So a run goes on
// where the one before it ended, with the same ids.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>

#include "daemon/steps/map_step.hpp"
#include "mapping/store/map_store.hpp"
#include "mapping/things/things.hpp"

namespace deltamap::daemon {

/// Called for each event, in order. `Things` are those up to it.
using ThingTold = std::function<void(const mapping::things::ThingEvent&)>;

/// Of all revisions that the store holds of its first map. What retention has made one step is taken as one. Throws
/// std::runtime_error where a revision cannot be read. A store holds no scans: what they have taken back of what was
/// assumed is assumed again. Up to the revision `newest`. `beat`, called now and then, may be empty.
[[nodiscard]] mapping::things::Things things_of(const mapping::store::MapStore& store,
                                                const mapping::things::ThingsParams& params = {},
                                                const ThingTold& told = {}, const std::function<void()>& beat = {},
                                                std::uint32_t newest = std::numeric_limits<std::uint32_t>::max());

/// What the newest revision tells; nothing where the result is none.
std::vector<mapping::things::ThingEvent> take_result(mapping::things::Things& things, const MapStep::Result& result);

}  // namespace deltamap::daemon
