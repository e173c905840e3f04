// SPDX-License-Identifier: Apache-2.0
// What tests write into the file of a map store: a history, and what no map store would.
#pragma once

#include <gtest/gtest.h>
#include <sqlite3.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "mapping/store/map_store.hpp"
#include "tests/support/daemon/stored_maps.hpp"
#include "tests/support/files/temporary_folder.hpp"

namespace deltamap::mapping::store {

/// The file of a store, in a folder of its own.
class StoreFile : public testing::Test {
 protected:
  test::TemporaryFolder folder;
  std::filesystem::path file = folder.path() / "store.sqlite";
};

/// Appends revisions up to `last` and returns every map.
inline std::vector<OccupancyGrid> fill(MapStore& store, std::uint32_t last) {
  std::vector<OccupancyGrid> maps{test::first_map()};
  for (std::uint32_t number = 1; number <= last; ++number) {
    const MapRevision revision = test::revision_after(maps.back(), number);
    store.append(revision, {number, 0.97, "evidence"});
    maps.push_back(*revision.map);
  }
  return maps;
}

/// From outside, as by another program.
inline void run_sql(const std::filesystem::path& file, const std::string& sql) {
  sqlite3* database = nullptr;
  ASSERT_EQ(sqlite3_open(file.c_str(), &database), SQLITE_OK);
  EXPECT_EQ(sqlite3_exec(database, sql.c_str(), nullptr, nullptr, nullptr), SQLITE_OK) << sqlite3_errmsg(database);
  sqlite3_close(database);
}

}  // namespace deltamap::mapping::store
