// SPDX-License-Identifier: Apache-2.0
#include "mapping/things/cell_clusters.hpp"

#include <cstdint>
#include <unordered_map>

namespace deltamap::mapping::things {
namespace {

std::int64_t key_of(Cell cell) { return (std::int64_t{cell.row} << 32) + cell.column; }

}  // namespace

std::vector<std::vector<CellChange>> cell_clusters(std::span<const CellChange> changes, int reach_cells) {
  std::unordered_map<std::int64_t, std::size_t> left;
  for (std::size_t i = 0; i < changes.size(); ++i) left.emplace(key_of(changes[i].cell), i);
  std::vector<std::vector<CellChange>> clusters;
  for (const CellChange& change : changes) {
    if (left.erase(key_of(change.cell)) == 0) continue;
    std::vector<CellChange> cluster{change};
    for (std::size_t next = 0; next < cluster.size(); ++next) {
      const Cell middle = cluster[next].cell;
      for (int row = -reach_cells; row <= reach_cells; ++row) {
        for (int column = -reach_cells; column <= reach_cells; ++column) {
          const auto near = left.find(key_of({middle.column + column, middle.row + row}));
          if (near == left.end()) continue;
          cluster.push_back(changes[near->second]);
          left.erase(near);
        }
      }
    }
    clusters.push_back(std::move(cluster));
  }
  return clusters;
}

}  // namespace deltamap::mapping::things
