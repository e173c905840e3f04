// SPDX-License-Identifier: Apache-2.0
// Files of older versions are brought up to date, or refused where something in them is damaged.
#include "mapping/store/store_upgrade.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "mapping/store/database.hpp"
#include "mapping/store/guarded_rows.hpp"
#include "mapping/store/store_schema.hpp"
#include "tests/mapping/store/written_store.hpp"
#include "tests/support/files/text_file.hpp"

namespace deltamap::mapping::store {
namespace {

namespace fs = std::filesystem;

using test::complaint;
using test::first_map;
using test::revision_after;

using StoreUpgrade = StoreFile;

TEST_F(StoreUpgrade, GoesOnWithAFileOfVersion1) {
  std::vector<OccupancyGrid> maps;
  {
    MapStore store{file, first_map()};
    maps = fill(store, 70);
    store.append_refusal(timestamp_from_ns(7), {2, 0.4, "low acceptance"});
  }
  make_older(file, 1);
  {
    const MapStore read{file};
    EXPECT_EQ(read.grid(70), maps[70]);
    EXPECT_FALSE(read.history()[70].note.covariance);
  }
  MapStore store{file, first_map()};
  for (std::uint32_t number = 0; number <= 70; ++number) EXPECT_EQ(store.grid(number), maps[number]) << number;
  store.append(revision_after(maps[70], 71), {3, 0.9, "evidence", PoseCovariance::Identity()});
  EXPECT_EQ(store.history().back().note.covariance, PoseCovariance::Identity());
}

TEST_F(StoreUpgrade, GoesOnWithAFileOfVersion2) {
  std::vector<OccupancyGrid> maps;
  {
    MapStore store{file, first_map()};
    maps = fill(store, 70);
    store.set_name(30, "before the move");
  }
  make_older(file, 2);
  MapStore store{file, first_map()};
  for (std::uint32_t number = 0; number <= 70; ++number) EXPECT_EQ(store.grid(number), maps[number]) << number;
  EXPECT_EQ(store.history()[30].name, "before the move");
  run_sql(file, "SELECT 1 FROM revision_copy WHERE number = 70 AND checksum IS NOT NULL");
}

TEST_F(StoreUpgrade, CallsNothingSoundInAnOlderFileThatIsNot) {
  {
    MapStore store{file, first_map()};
    fill(store, 100);
  }
  make_older(file, 2);
  const std::string sound = test::content_of(file);
  for (const int number : {9, 70, 100}) {
    (void)folder.write("store.sqlite", sound);
    run_sql(file, "UPDATE revision SET changes = (SELECT changes FROM revision WHERE number = 1) WHERE number = " +
                      std::to_string(number));
    EXPECT_EQ(complaint([&] { MapStore store(file, first_map()); }).find(file.string() + ": damaged: revision "), 0u);
    run_sql(file, "SELECT 1 FROM named");  // it is as it was
  }
}

TEST_F(StoreUpgrade, HasItsTablesOnTheSamePagesWhetherNewOrBroughtUpToDate) {
  const auto pages = [](const fs::path& of) {
    Database database{of, Database::Mode::kRead};
    return database.text("SELECT group_concat(name || ' ' || rootpage, ', ') FROM sqlite_master");
  };
  {
    MapStore store{file, first_map()};
    fill(store, 70);
  }
  const std::string made = pages(file);
  make_older(file, 2);
  { const MapStore store{file, first_map()}; }
  EXPECT_EQ(pages(file), made);
}

TEST_F(StoreUpgrade, LeavesAStoreOfThisVersionAsItIs) {
  { const MapStore store{file, first_map()}; }
  Database database{file, Database::Mode::kExisting};
  bring_up_to_date(database);
  EXPECT_EQ(damaged_row(database), "");
}

}  // namespace
}  // namespace deltamap::mapping::store
