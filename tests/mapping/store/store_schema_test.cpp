// SPDX-License-Identifier: Apache-2.0
// Files that the store makes or refuses.
#include "mapping/store/store_schema.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "mapping/store/database.hpp"
#include "tests/mapping/store/written_store.hpp"
#include "tests/support/files/text_file.hpp"

namespace deltamap::mapping::store {
namespace {

namespace fs = std::filesystem;

using test::complaint;
using test::first_map;

using StoreSchema = StoreFile;

TEST_F(StoreSchema, RefusesAFileOfALaterVersion) {
  { const MapStore store{file, first_map()}; }
  run_sql(file, "PRAGMA user_version = 4");
  EXPECT_EQ(complaint([&] { MapStore store{file}; }), file.string() + ": map store of version 4, not 1 to 3");
}

TEST_F(StoreSchema, NamesTheFileThatIsNoStore) {
  const fs::path text = folder.write("notes.txt", std::string(5000, 'x'));
  const fs::path empty = folder.write("empty.sqlite", "");
  run_sql(folder.path() / "foreign.sqlite", "CREATE TABLE songs (name TEXT)");
  for (const fs::path& bad : {text, folder.path() / "foreign.sqlite", folder.path(), folder.path() / "no" / "where"}) {
    const std::string line = complaint([&] { MapStore store(bad, first_map()); });
    EXPECT_EQ(line.find(bad.string()), 0u) << line;
    EXPECT_EQ(line.find('\n'), std::string::npos) << line;
  }
  EXPECT_EQ(complaint([&] { MapStore store{empty}; }), empty.string() + ": not a map store");
  const fs::path missing = folder.path() / "missing.sqlite";
  EXPECT_EQ(complaint([&] { MapStore store{missing}; }), missing.string() + ": no such file");
  EXPECT_FALSE(fs::exists(missing));
}

}  // namespace
}  // namespace deltamap::mapping::store
