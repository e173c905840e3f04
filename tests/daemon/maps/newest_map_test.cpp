// SPDX-License-Identifier: Apache-2.0
// map.newest: the newest revision for other programs. What the store's retention does while the daemon runs.
#include "daemon/maps/newest_map.hpp"

#include "core/files/file_lock.hpp"
#include "core/files/grid_file.hpp"
#include "daemon/maps/map_outputs.hpp"
#include "daemon/settings/start_error.hpp"
#include "mapping/store/map_store.hpp"
#include "tests/support/daemon/saving_fixture.hpp"
#include "tests/support/files/full_disk.hpp"

namespace deltamap::daemon {
namespace {

namespace fs = std::filesystem;
using mapping::store::MapStore;
using test::at_s;

OccupancyGrid map_of(std::uint32_t number, GridGeometry geometry = {40, 30, 0.1, {0.0, 0.0}}) {
  OccupancyGrid map{geometry, CellState::kFree};
  for (std::uint32_t cell = 0; cell < number; ++cell) {
    map.set({static_cast<int>(cell % 40), static_cast<int>(cell / 40)}, CellState::kOccupied);
  }
  return map;
}

MapStep::Result result_of(std::uint32_t number) {
  auto map = std::make_shared<const OccupancyGrid>(map_of(number));
  MapStep::Result result;
  result.revision = MapRevision{.number = number,
                                .time = at_s(number),
                                .map = map,
                                .changes = changes_between(map_of(number - 1), *map),
                                .field_patch = {}};
  result.note.revision = number;
  return result;
}

class NewestMap : public test::SavingFixture {
 protected:
  [[nodiscard]] MapOutputs::Options options(const mapping::store::Retention& retention = {}) const {
    StoreToKeep to;
    to.store.emplace(store, map_of(0));
    to.retention = retention;
    return {.store_file = store,
            .newest_file = newest,
            .store = std::move(to),
            .start = {.map = std::make_shared<const OccupancyGrid>(map_of(0))},
            .method = "evidence"};
  }
  [[nodiscard]] std::size_t kept() const { return MapStore{store}.history().size(); }
  [[nodiscard]] MapSettings settings() const {
    return {.file = folder.path() / "site.yaml", .store = store, .retention = {}, .newest = newest};
  }
  std::string refusal(const MapSettings& map) {
    try {
      (void)judged_newest_place(map);
    } catch (const StartError& error) {
      return error.what();
    }
    return "";
  }

  fs::path store = folder.path() / "store.sqlite";
  fs::path newest = folder.path() / "map.yaml";
};

TEST_F(NewestMap, IsThereFromTheStartAndAfterEveryRevision) {
  MapOutputs outputs{options(), telemetry.outputs, warn(), at_s(0)};
  EXPECT_EQ(read_grid(newest), map_of(0));
  for (std::uint32_t number : {1u, 2u, 3u}) {
    outputs.save(result_of(number), at_s(number));
    EXPECT_EQ(read_grid(newest), map_of(number));
  }
  EXPECT_FALSE(fs::exists(folder.path() / "map.pgm.part"));
}

TEST_F(NewestMap, StaysWholeWhileTheDiskIsFullAndFollowsWhenItIsNot) {
  MapOutputs outputs{options(), telemetry.outputs, warn(), at_s(0)};
  outputs.save(result_of(1), at_s(1));
  {
    const test::FullDisk full{200};  // in the middle of the picture
    outputs.save(result_of(2), at_s(2));
    EXPECT_EQ(read_grid(newest), map_of(1));
    EXPECT_FALSE(status("newest").written);
  }
  outputs.retry(at_s(10));
  EXPECT_EQ(read_grid(newest), map_of(2));
  EXPECT_TRUE(status("newest").written);
}

TEST_F(NewestMap, OfAnotherSizeNeverLiesBesideTheOldDescription) {
  write_grid(map_of(5), newest);
  write_grid(map_of(5, {20, 10, 0.2, {1.0, 2.0}}), newest);
  EXPECT_EQ(read_grid(newest), map_of(5, {20, 10, 0.2, {1.0, 2.0}}));
  {
    const test::FullDisk full{100};  // before anything of the old one is touched
    EXPECT_THROW(write_grid(map_of(5), newest), std::runtime_error);
  }
  EXPECT_EQ(read_grid(newest), map_of(5, {20, 10, 0.2, {1.0, 2.0}}));
  std::size_t files = 0;
  for (const auto& entry : fs::directory_iterator(folder.path())) files += entry.is_regular_file() ? 1 : 0;
  EXPECT_EQ(files, 2u) << "drafts are left";
}

TEST_F(NewestMap, IsNamedByItsDescriptionInAFolderThatIsThere) {
  EXPECT_EQ(refusal(settings()), "");
  for (const char* name : {"map.pgm", "map", "maps/"}) {
    MapSettings map = settings();
    map.newest = name;
    EXPECT_EQ(refusal(map), "'map.newest' must name a description, NAME.yaml, not '" + std::string(name) + "'");
  }
  MapSettings nowhere = settings();
  nowhere.newest = folder.path() / "missing" / "map.yaml";
  EXPECT_EQ(refusal(nowhere).find(nowhere.newest), 0u) << refusal(nowhere);
}

TEST_F(NewestMap, BelongsToOneDaemon) {
  const auto lock = newest_map_lock(settings());
  ASSERT_TRUE(lock);
  EXPECT_THROW((void)newest_map_lock(settings()), FileInUse);
  MapSettings same_picture = settings();
  same_picture.newest = fs::path(same_picture.newest).replace_extension(".yml");
  EXPECT_THROW((void)newest_map_lock(same_picture), FileInUse) << "both would write it";
  MapSettings none = settings();
  none.newest.clear();
  EXPECT_FALSE(newest_map_lock(none));
}

TEST_F(NewestMap, TheStoreIsThinnedOutAStretchAtATimeWhileNothingElseIsToBeDone) {
  MapOutputs outputs{options({.revisions = 5}), telemetry.outputs, warn(), at_s(0)};
  for (std::uint32_t number = 1; number <= 133; ++number) outputs.save(result_of(number), at_s(number));
  EXPECT_EQ(kept(), 134u) << "a revision never waits for it";
  outputs.retry(at_s(134));
  EXPECT_EQ(kept(), 71u);
  outputs.retry(at_s(135));
  EXPECT_EQ(kept(), 8u) << "0, 64, 128 to 133";
  EXPECT_TRUE(warnings.empty());
  const MapStore seen{store};
  for (const std::uint32_t number : {0u, 64u, 128u, 131u, 133u}) EXPECT_EQ(seen.grid(number), map_of(number));
}

TEST_F(NewestMap, TheStoreIsThinnedOutWhenThereIsRoomAgain) {
  std::optional<MapOutputs> outputs{std::in_place, options({.days = 1.0}), telemetry.outputs, warn(), at_s(0)};
  for (std::uint32_t number = 1; number <= 70; ++number) outputs->save(result_of(number), at_s(number));
  const double later_s = 3 * 86'400.0;
  {
    const test::FullDisk full;
    outputs->retry(at_s(later_s));
    EXPECT_FALSE(status("store").written);
  }
  EXPECT_EQ(kept(), 71u);
  outputs->retry(at_s(later_s + 10));
  EXPECT_TRUE(status("store").written) << status("store").why;
  EXPECT_EQ(kept(), 8u);
}

TEST_F(NewestMap, OldRevisionsAreLookedForOnceAMinuteAndAtOnceWhereTheClockHasJumpedBack) {
  MapOutputs outputs{options({.days = 1.0}), telemetry.outputs, warn(), at_s(0)};
  for (std::uint32_t number = 1; number <= 70; ++number) outputs.save(result_of(number), at_s(number));
  const double due_s = 86'400.0 + 64;  // the first of them that are a day old, all 64
  outputs.retry(at_s(due_s - 30));
  outputs.retry(at_s(due_s + 20));
  EXPECT_EQ(kept(), 71u);
  outputs.retry(at_s(due_s + 31));
  EXPECT_EQ(kept(), 8u);
  outputs.save(result_of(71), at_s(due_s + 32));
  outputs.retry(at_s(due_s + 33));
  outputs.retry(at_s(100));
  EXPECT_TRUE(warnings.empty());
}

}  // namespace
}  // namespace deltamap::daemon
