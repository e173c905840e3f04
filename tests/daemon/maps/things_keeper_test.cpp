// SPDX-License-Identifier: Apache-2.0
#include "daemon/maps/things_keeper.hpp"

#include "tests/mapping/things/drawn_site.hpp"
#include "tests/support/daemon/saving_fixture.hpp"
#include "tests/support/files/text_file.hpp"

namespace deltamap::daemon {
namespace {

using mapping::store::MapStore;
using mapping::things::DrawnSite;
using mapping::things::kBox;
using test::content_of;

class ThingsKeeperTest : public test::SavingFixture {
 protected:
  [[nodiscard]] ThingsKeeper begun(const MapStore* from) {
    return {{.store = from, .out = folder.path(), .kept = kept}, telemetry.outputs, warn(), test::at_s(0)};
  }
  /// What is drawn becomes a revision of the run, and of the store.
  MapStep::Result revision() {
    (void)site.revision(10.0 * (site.number + 1));
    MapStep::Result result;
    result.revision = MapRevision{.number = site.number,
                                  .time = DrawnSite::at(10.0 * site.number),
                                  .map = std::make_shared<const OccupancyGrid>(site.map),
                                  .changes = site.revisions.back(),
                                  .field_patch = {}};
    store.append(*result.revision, {.phase = site.number, .acceptance = 0.9, .cause = "evidence"});
    return result;
  }

  DrawnSite site;
  MapStore store{folder.path() / "store.sqlite", site.map};
  std::filesystem::path kept = folder.path() / "store.things.jsonl";
};

TEST_F(ThingsKeeperTest, AfterARestartTheThingsAreTheSameAndGoOn) {
  ThingsKeeper first = begun(nullptr);
  site.box(kBox);
  EXPECT_EQ(first.take(revision(), test::at_s(1)).size(), 1u);
  site.box({8.0, 4.0, 9.0, 5.0});
  (void)first.take(revision(), test::at_s(2));
  const std::string told = content_of(kept);
  EXPECT_EQ(std::count(told.begin(), told.end(), '\n'), 2);

  ThingsKeeper second = begun(&store);
  EXPECT_EQ(second.list()->things, first.list()->things);
  EXPECT_EQ(second.list()->corrections, first.list()->corrections);
  EXPECT_EQ(content_of(kept), told);
  EXPECT_EQ(content_of(folder.path() / "things.jsonl"), "") << "of this run alone";
  site.clear(kBox);
  const auto events = second.take(revision(), test::at_s(3));
  ASSERT_EQ(events.size(), 1u);
  EXPECT_EQ(events[0].thing.id, 1u);
  EXPECT_EQ(events[0].thing.kind, mapping::things::ThingKind::kGone);
}

TEST_F(ThingsKeeperTest, BeamsThroughWhatIsAssumedAreToldInBothFiles) {
  ThingsKeeper keeper = begun(nullptr);
  site.south(kBox).west(kBox);
  ASSERT_EQ(keeper.take(revision(), test::at_s(1)).size(), 1u);
  EXPECT_NE(content_of(kept).find("\"sides_assumed\":[true,true,false,false]"), std::string::npos) << content_of(kept);
  TrackedScan tracked;
  for (int i = 0; i < 5; ++i) tracked.rays.push_back({{0.0F, 0.0F}, {8.0F, 0.1F * static_cast<float>(i)}});
  tracked.estimate.map_from_robot = {1.0, 4.8, 0.0};
  EXPECT_TRUE(keeper.look(tracked, test::at_s(2)).empty());
  ASSERT_EQ(keeper.look(tracked, test::at_s(3)).size(), 1u);
  for (const auto& file : {kept, folder.path() / "things.jsonl"}) {
    EXPECT_NE(content_of(file).find("\"sides_assumed\":[false,false,false,false]"), std::string::npos) << file;
  }
}

TEST_F(ThingsKeeperTest, WhatTakesAThingBackSetsItsCellsToWhatTheyWere) {
  const OccupancyGrid before = site.map;
  ThingsKeeper keeper = begun(nullptr);
  site.box(kBox).fill({1.0, 1.0, 2.0, 1.0}, CellState::kOccupied);
  (void)keeper.take(revision(), test::at_s(1));
  const auto list = keeper.list();
  ASSERT_EQ(list->things.size(), 2u);
  OccupancyGrid map = site.map;
  for (const mapping::things::Thing& thing : list->things) map = patched(std::move(map), keeper.undoing(thing.id, map));
  EXPECT_EQ(map, before);
  EXPECT_THROW((void)keeper.undoing(3, site.map), std::runtime_error);
}

TEST_F(ThingsKeeperTest, OfWhatHasLeftOnlyWholeRevisionsCanBeUndone) {
  ThingsKeeper keeper = begun(nullptr);
  site.box(kBox);
  (void)keeper.take(revision(), test::at_s(1));
  site.clear(kBox);
  (void)keeper.take(revision(), test::at_s(2));
  try {
    (void)keeper.undoing(1, site.map);
    ADD_FAILURE() << "there is nothing to set back";
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(),
                 "no cell holds any more what thing 1 has written; `undo K` takes its whole revisions: 1 2");
  }
}

TEST_F(ThingsKeeperTest, ARefusalTellsNothing) {
  ThingsKeeper keeper = begun(nullptr);
  EXPECT_TRUE(keeper.take({}, test::at_s(1)).empty());
  EXPECT_TRUE(keeper.list()->things.empty());
}

}  // namespace
}  // namespace deltamap::daemon
