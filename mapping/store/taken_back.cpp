// SPDX-License-Identifier: Apache-2.0
#include "mapping/store/taken_back.hpp"

namespace deltamap::mapping::store {

std::vector<CellChange> taken_back(const OccupancyGrid& map, std::span<const CellChange> delta) {
  std::vector<CellChange> back;
  for (const CellChange& change : delta) {
    if (map.at(change.cell) == change.after && change.before != change.after) {
      back.push_back({change.cell, change.after, change.before});
    }
  }
  return back;
}

}  // namespace deltamap::mapping::store
