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

/// What version 1 or 2 would have written: without checksums and copies, names in a table of their own.
inline void make_older(const std::filesystem::path& file, int version) {
  run_sql(file,
          "CREATE TABLE named (map INTEGER, number INTEGER, name TEXT NOT NULL, PRIMARY KEY (map, number));"
          "INSERT INTO named SELECT map, number, name FROM revision WHERE name IS NOT NULL;"
          "DROP TABLE map_copy; DROP TABLE revision_copy; ALTER TABLE map DROP COLUMN checksum;"
          "ALTER TABLE map DROP COLUMN provisional; ALTER TABLE revision DROP COLUMN checksum;"
          "ALTER TABLE revision DROP COLUMN name; PRAGMA user_version = " +
              std::to_string(version));
  for (const char* column : {"xx_m2", "xy_m2", "xh_m_rad", "yy_m2", "yh_m_rad", "hh_rad2"}) {
    if (version == 1) run_sql(file, std::string("ALTER TABLE revision DROP COLUMN ") + column);
  }
}

}  // namespace deltamap::mapping::store
