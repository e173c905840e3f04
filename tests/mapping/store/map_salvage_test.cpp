// SPDX-License-Identifier: Apache-2.0
#include "mapping/store/map_salvage.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "tests/mapping/store/written_store.hpp"

namespace deltamap::mapping::store {
namespace {

class MapSalvage : public StoreFile {
 protected:
  /// M_0 to M_last, of which every 64th is whole.
  void write(std::uint32_t last) {
    MapStore store{file, test::first_map()};
    maps = fill(store, last);
  }
  void damage(const std::string& what) const { run_sql(file, "UPDATE revision SET " + what); }
  [[nodiscard]] std::string bytes() const {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  void expect_salvaged(std::uint32_t number) const {
    const std::optional<SalvagedMap> salvaged = newest_whole_map(file, test::first_map());
    ASSERT_TRUE(salvaged);
    EXPECT_EQ(salvaged->number, number);
    EXPECT_EQ(salvaged->grid, maps[number]);
    EXPECT_EQ(salvaged->time, timestamp_from_ns(std::int64_t{number} * 1'000'000'000));
  }

  std::vector<OccupancyGrid> maps;
};

TEST_F(MapSalvage, IsTheNewestOfASoundStoreWhichIsLeftAsItIs) {
  write(10);
  const std::string before = bytes();
  expect_salvaged(10);
  EXPECT_EQ(bytes(), before);
}

TEST_F(MapSalvage, IsTheLastBeforeAStepThatIsDamaged) {
  write(10);
  damage("changes = x'FFFFFFFF' WHERE number = 8");
  expect_salvaged(7);
}

TEST_F(MapSalvage, GoesOnFromAWholeMapBehindTheDamage) {
  write(70);
  damage("changes = x'FFFFFFFF' WHERE number = 30");
  expect_salvaged(70);
}

TEST_F(MapSalvage, GoesBackToTheWholeMapBeforeOneThatIsDamaged) {
  write(70);
  damage("grid = x'00' WHERE number = 64");
  damage("changes = x'FFFFFFFF' WHERE number = 60");
  expect_salvaged(59);
}

TEST_F(MapSalvage, HoldsNoMapThatIsNotWhatWasWritten) {
  write(5);
  damage("changes = (SELECT changes FROM revision WHERE number = 1) WHERE number = 5");
  expect_salvaged(4);
}

TEST_F(MapSalvage, IsNothingWhereOnlyTheFirstMapIsLeft) {
  write(0);
  EXPECT_FALSE(newest_whole_map(file, test::first_map()));
}

TEST_F(MapSalvage, IsNothingOfAnotherFirstMap) {
  write(5);
  OccupancyGrid other = test::first_map();
  other.set({3, 3}, CellState::kOccupied);
  EXPECT_FALSE(newest_whole_map(file, other));
}

TEST_F(MapSalvage, IsNothingOfAFileThatIsNoStoreOrMissing) {
  EXPECT_FALSE(newest_whole_map(folder.write("notes.txt", std::string(5000, 'x')), test::first_map()));
  EXPECT_FALSE(newest_whole_map(folder.path() / "missing.sqlite", test::first_map()));
}

}  // namespace
}  // namespace deltamap::mapping::store
