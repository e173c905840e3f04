// SPDX-License-Identifier: Apache-2.0
// The newest states of all bays: the delta thread puts them here, control and page read them.
#pragma once

#include <vector>

#include "daemon/outputs/newest_board.hpp"
#include "mapping/bays/bay.hpp"

namespace deltamap::daemon {

struct BayList {
  std::vector<mapping::bays::Bay> bays;
  std::vector<mapping::bays::BayStatus> statuses;  ///< of each
  std::vector<bool> is_remembered{};  ///< of each: by an earlier run, and this one has never known it; empty: none is
};

using BaysBoard = NewestBoard<BayList>;

}  // namespace deltamap::daemon
