// SPDX-License-Identifier: Apache-2.0
// The newest list of things: the map thread puts it here, control and page read it.
#pragma once

#include <cstdint>
#include <vector>

#include "daemon/outputs/newest_board.hpp"
#include "mapping/things/thing.hpp"

namespace deltamap::daemon {

struct ThingList {
  std::vector<mapping::things::Thing> things;  ///< in the order of their ids
  std::uint64_t corrections = 0;               ///< changed cells that belong to no thing
  std::uint64_t forgotten = 0;                 ///< things that are no longer listed
};

using ThingsBoard = NewestBoard<ThingList>;

}  // namespace deltamap::daemon
