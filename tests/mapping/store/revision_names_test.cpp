// SPDX-License-Identifier: Apache-2.0
#include "mapping/store/revision_names.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "mapping/store/guarded_rows.hpp"
#include "mapping/store/store_schema.hpp"
#include "tests/support/daemon/stored_maps.hpp"
#include "tests/support/files/temporary_folder.hpp"

namespace deltamap::mapping::store {
namespace {

using Names = std::map<std::uint32_t, std::string>;

constexpr std::int64_t kMap = 17;
constexpr std::int64_t kOtherMap = 18;

/// Revision 5 of either map, as a step that is not kept whole.
class RevisionNames : public testing::Test {
 protected:
  RevisionNames() {
    for (const std::int64_t map : {kMap, kOtherMap}) {
      database.run("INSERT INTO revision (map, number, refused) VALUES (" + std::to_string(map) + ", 5, 0)");
    }
    guard(database, Table::kRevision, "true");
  }
  [[nodiscard]] std::int64_t kept_whole() {
    return database.number("SELECT count(*) FROM revision WHERE grid IS NOT NULL");
  }
  [[nodiscard]] Names names_of(std::int64_t map) {
    Names names;
    Statement rows{database, "SELECT number, name FROM revision WHERE map = ? AND name IS NOT NULL"};
    rows.bind(map);
    while (rows.step()) names.emplace(static_cast<std::uint32_t>(rows.number(0)), rows.text(1));
    return names;
  }
  void write(const std::string& name) { write_name(database, kMap, 5, name, grid); }

  test::TemporaryFolder folder;
  Database database = opened_store(folder.path() / "store.sqlite", Database::Mode::kCreate);
  const std::vector<std::uint8_t> grid{1, 2, 3};
};

TEST_F(RevisionNames, AreOfOneMapAndTheNewestCounts) {
  EXPECT_EQ(names_of(kMap), Names{});
  write("before the move");
  write("after the move");
  EXPECT_EQ(names_of(kMap), (Names{{5, "after the move"}}));
  EXPECT_EQ(names_of(kOtherMap), Names{});
}

TEST_F(RevisionNames, KeepTheRevisionWholeEvenOnceTheyAreTakenAway) {
  EXPECT_EQ(kept_whole(), 0);
  write("before the move");
  EXPECT_EQ(kept_whole(), 1);
  write("");
  EXPECT_EQ(names_of(kMap), Names{});
  EXPECT_EQ(kept_whole(), 1);
}

TEST_F(RevisionNames, LeaveTheRowWithItsChecksumAndItsCopy) {
  write("before the move");
  EXPECT_EQ(damaged_row(database), "");
  write("");
  EXPECT_EQ(damaged_row(database), "");
}

TEST_F(RevisionNames, AreNotGivenToADamagedRow) {
  database.run("UPDATE revision SET phase = 3");
  EXPECT_NE(test::complaint([&] { write("before the move"); }).find("damaged: revision 5 is not what was written"),
            std::string::npos);
}

TEST_F(RevisionNames, AreOneLineOfAtMost80Bytes) {
  EXPECT_NE(test::complaint([&] { write("two\nlines"); }), "");
  EXPECT_NE(test::complaint([&] { write(std::string(81, 'x')); }), "");
  EXPECT_EQ(names_of(kMap), Names{});
  write(std::string(80, 'x'));
  EXPECT_EQ(names_of(kMap).size(), 1U);
}

}  // namespace
}  // namespace deltamap::mapping::store
