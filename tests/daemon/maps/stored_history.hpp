// SPDX-License-Identifier: Apache-2.0
// The file of a map store with a history of its own, as the next start of the daemon finds it.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <memory>
#include <vector>

#include "core/grid/grid_patch.hpp"
#include "core/random.hpp"
#include "daemon/kept/kept_pose.hpp"
#include "mapping/store/map_store.hpp"
#include "tests/support/files/temporary_folder.hpp"

namespace deltamap::daemon {

class StoredHistory : public testing::Test {
 protected:
  static constexpr std::uint32_t kRevisions = 150;  // more than two whole grids

  static OccupancyGrid first_map(int side = 200) {
    OccupancyGrid grid{{side, side, 0.1, {0.0, 0.0}}, CellState::kFree};
    Random random{1};  // runs that do not shrink to nothing
    for (int i = 0; i < 4000; ++i) grid.set(cell_of(random, side), CellState::kOccupied);
    return grid;
  }
  static Cell cell_of(Random& random, int side) {
    const auto size = static_cast<std::uint32_t>(side);
    return {static_cast<int>(random.index_below(size)), static_cast<int>(random.index_below(size))};
  }

  void fill() {
    mapping::store::MapStore store{file, first};
    Random random{2};
    maps.push_back(first);
    for (std::uint32_t number = 1; number <= kRevisions; ++number) {
      OccupancyGrid after = maps.back();
      for (int i = 0; i < 30; ++i) after.set(cell_of(random, 200), CellState::kUnknown);
      MapRevision revision{.number = number,
                           .time = timestamp_from_ns(number),
                           .map = std::make_shared<const OccupancyGrid>(after),
                           .changes = changes_between(maps.back(), after),
                           .field_patch = {}};
      store.append(revision, {.cause = "evidence"});
      maps.push_back(std::move(after));
    }
  }

  /// As a run does that has known so many revisions.
  void keep_pose_of(std::uint32_t revision, std::uint64_t first_map) const {
    KeptPose pose;
    pose.first_map = first_map;
    pose.revision = revision;
    (void)folder.write("store.pose.json", json_text(pose));
  }
  void keep_pose_of(std::uint32_t revision) const { keep_pose_of(revision, grid_hash(first)); }

  test::TemporaryFolder folder;
  std::filesystem::path file = folder.path() / "store.sqlite";
  OccupancyGrid first = first_map();
  std::vector<OccupancyGrid> maps{};
};

}  // namespace deltamap::daemon
