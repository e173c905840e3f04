// SPDX-License-Identifier: Apache-2.0
#include "tool/picture/changed_places.hpp"

#include "mapping/things/cell_clusters.hpp"

namespace deltamap::tool::picture {

std::vector<CellBox> changed_places(std::span<const CellChange> changes, int reach_cells) {
  std::vector<CellBox> places;
  for (const auto& cluster : mapping::things::cell_clusters(changes, reach_cells))
    places.push_back(bounding_box(cluster));
  return places;
}

}  // namespace deltamap::tool::picture
