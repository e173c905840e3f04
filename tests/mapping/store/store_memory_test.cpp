// SPDX-License-Identifier: Apache-2.0
// What an open map store holds in memory, however long its history becomes.
#include <gtest/gtest.h>
#include <sqlite3.h>

#include "mapping/store/map_store.hpp"
#include "tests/support/daemon/stored_maps.hpp"
#include "tests/support/files/figure.hpp"
#include "tests/support/files/temporary_folder.hpp"

namespace deltamap::mapping::store {
namespace {

constexpr std::uint32_t kSide = 200;             // cells
constexpr int kChangedCells = 300;               // a revision: about 1 kB of history
constexpr std::int64_t kSlack_bytes = 64 << 10;  // of statements and buffers that come and go

class GrowingStore {
 public:
  /// Bytes that SQLite holds once the history has so many revisions.
  std::int64_t bytes_held_after(std::uint32_t revisions) {
    while (store_.newest() < revisions) {
      const MapRevision revision = test::revision_after(*map_, store_.newest() + 1, kChangedCells);
      store_.append(revision, {1, 0.97, "evidence"});
      map_ = revision.map;
    }
    return sqlite3_memory_used();
  }

 private:
  test::TemporaryFolder folder_;
  std::shared_ptr<const OccupancyGrid> map_ =
      std::make_shared<const OccupancyGrid>(GridGeometry{kSide, kSide, 0.05, {0.0, 0.0}}, CellState::kFree);
  MapStore store_{folder_.path() / "store.sqlite", *map_};
};

TEST(StoreMemory, HoldsNoMoreOfALongHistoryThanOfAShortOne) {
  GrowingStore store;
  const std::int64_t early = store.bytes_held_after(500);
  const std::int64_t late = store.bytes_held_after(1500);
  test::tell_figure("store_growth", 1e-3 * static_cast<double>(late - early), "kB");
  EXPECT_LE(late - early, kSlack_bytes);
}

}  // namespace
}  // namespace deltamap::mapping::store
