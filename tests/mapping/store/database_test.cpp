// SPDX-License-Identifier: Apache-2.0
#include "mapping/store/database.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "tests/support/daemon/stored_maps.hpp"
#include "tests/support/files/temporary_folder.hpp"

namespace deltamap::mapping::store {
namespace {

class DatabaseFile : public testing::Test {
 protected:
  DatabaseFile() { database.run("CREATE TABLE kept (number INTEGER, share REAL, name TEXT, bytes BLOB)"); }
  [[nodiscard]] std::int64_t rows() { return database.number("SELECT count(*) FROM kept"); }

  test::TemporaryFolder folder;
  std::filesystem::path file = folder.path() / "kept.sqlite";
  Database database{file, Database::Mode::kCreate};
};

TEST_F(DatabaseFile, GivesBackWhatWasBound) {
  const std::vector<std::uint8_t> bytes{0x00, 0xFF, 0x7F};
  Statement write{database, "INSERT INTO kept VALUES (?, ?, ?, ?)"};
  write.bind(std::int64_t{-5'000'000'000}).bind(0.25).bind(std::string{"before the move"}).bind(bytes);
  EXPECT_FALSE(write.step());
  Statement read{database, "SELECT number, share, name, bytes FROM kept"};
  ASSERT_TRUE(read.step());
  EXPECT_EQ(read.number(0), -5'000'000'000);
  EXPECT_EQ(read.real(1), 0.25);
  EXPECT_EQ(read.text(2), "before the move");
  EXPECT_EQ(read.blob(3), bytes);
  EXPECT_FALSE(read.step()) << "one row";
}

TEST_F(DatabaseFile, HoldsNothingOfATransactionThatWasNotCommitted) {
  {
    const Transaction all{database};
    database.run("INSERT INTO kept (number) VALUES (1)");
    EXPECT_EQ(rows(), 1);
  }
  EXPECT_EQ(rows(), 0);
  Transaction all{database};
  database.run("INSERT INTO kept (number) VALUES (1)");
  all.commit();
  EXPECT_EQ(Database(file, Database::Mode::kRead).number("SELECT count(*) FROM kept"), 1);
}

TEST_F(DatabaseFile, NamesTheFileThatAStatementFailsOn) {
  const std::string line = test::complaint([&] { database.run("SELECT * FROM songs"); });
  EXPECT_EQ(line, file.string() + ": no such table: songs");
}

TEST_F(DatabaseFile, IsNotWrittenWhereItIsOpenedToBeRead) {
  Database read{file, Database::Mode::kRead};
  try {
    read.run("INSERT INTO kept (number) VALUES (1)");
    ADD_FAILURE() << "written";
  } catch (const StoreError& error) {
    EXPECT_EQ(error.kind, StoreError::Kind::kReadOnly);
  }
  EXPECT_EQ(rows(), 0);
}

}  // namespace
}  // namespace deltamap::mapping::store
