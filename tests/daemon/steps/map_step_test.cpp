// SPDX-License-Identifier: Apache-2.0
// What the map thread makes of sets and of orders to withdraw.
#include "daemon/steps/map_step.hpp"

#include <gtest/gtest.h>

#include "daemon/maps/revision_keeper.hpp"
#include "mapping/map_update.hpp"
#include "mapping/store_scan.hpp"
#include "tests/support/files/temporary_folder.hpp"
#include "tests/support/scans/drawn_scan.hpp"
#include "tests/support/worlds/drawn_hall.hpp"

namespace deltamap::daemon {
namespace {

Timestamp at(double time_s) { return timestamp_from_ns(1'000'000'000'000) + duration_from_seconds(time_s); }

/// A hall in which a box has appeared, driven past once: the set that draws it.
class Withdrawal : public testing::Test {
 protected:
  Withdrawal() {
    test::fill(with_box, {9.0, 8.0}, {11.0, 8.5}, CellState::kOccupied);
    test::fill(with_two, {9.0, 8.0}, {11.0, 8.5}, CellState::kOccupied);
    test::fill(with_two, {14.0, 7.5}, {15.0, 8.0}, CellState::kOccupied);
  }

  /// Drives until a set changes the map.
  MapStep::Result change(const OccupancyGrid& world) {
    test::DrawnScanParams noise;
    for (int scan = 0; scan < 600; ++scan, time_s += 0.2) {
      const Pose2 pose = test::below_the_containers(time_s);
      const auto request = store_scan.observe(test::drawn_scan(world, step.map(), pose, time_s, random, noise));
      if (!request) continue;
      std::optional<MapStep::Result> result = step.take(*request);
      if (result && result->revision) return *std::move(result);
    }
    ADD_FAILURE() << "nothing was written";
    return {};
  }
  [[nodiscard]] MapStep::Result withdraw(Timestamp from, double after_s) {
    return *step.take(WithdrawOrder{.time = at(time_s + after_s), .from = from});
  }

  OccupancyGrid hall = test::drawn_hall(0.05);
  OccupancyGrid with_box = hall;
  OccupancyGrid with_two = hall;
  Settings settings;
  MapStep step{settings, {std::make_shared<const OccupancyGrid>(hall), 0}};
  mapping::StoreScan store_scan{settings.mapping.store_scan, 1};
  Random random{5};
  double time_s = 0.0;
};

TEST_F(Withdrawal, TakesEverythingProvisionalBackInOneRevision) {
  (void)change(with_box);
  const std::uint32_t written = step.revision();
  const MapStep::Result result = withdraw(Timestamp::min(), 1.0);
  ASSERT_TRUE(result.revision);
  EXPECT_EQ(*result.revision->map, hall);
  EXPECT_EQ(result.revision->number, written + 1);
  EXPECT_EQ(*step.map(), hall);
  EXPECT_EQ(result.note.reason, "withdrawn");
  EXPECT_EQ(result.note.withdraws.back(), written);
  EXPECT_FALSE(result.revision->field_patch.box.empty()) << "the localizer takes it like any revision";
  EXPECT_NE(json_line(result.note).find("\"withdraws\":["), std::string::npos);
}

TEST_F(Withdrawal, LeavesWhatWasWrittenBefore) {
  (void)change(with_box);
  const OccupancyGrid kept = *step.map();
  const Timestamp between = at(time_s + 0.05);
  time_s += 0.2;
  (void)change(with_two);
  ASSERT_NE(*step.map(), kept);
  (void)withdraw(between, 1.0);
  EXPECT_EQ(*step.map(), kept);
}

TEST_F(Withdrawal, LeavesWhatIsSettled) {
  const MapStep::Result written = change(with_box);
  const OccupancyGrid kept = *step.map();
  ScanSet later;
  later.settled = written.note.time + std::chrono::nanoseconds{1};
  (void)step.take(later);
  const MapStep::Result result = withdraw(Timestamp::min(), 1.0);
  EXPECT_FALSE(result.revision);
  EXPECT_EQ(result.note.reason, "nothing to withdraw");
  EXPECT_EQ(*step.map(), kept);
}

TEST_F(Withdrawal, LeavesWhatIsSettledByWordOfItsOwn) {
  (void)change(with_box);
  EXPECT_EQ(step.provisional_numbers(), std::vector<std::uint32_t>{step.revision()});
  EXPECT_FALSE(step.take(Settlement{at(time_s + 1.0)}));
  EXPECT_TRUE(step.provisional_numbers().empty());
  EXPECT_FALSE(withdraw(Timestamp::min(), 2.0).revision);
}

TEST_F(Withdrawal, TakesBackWhatTheRunBeforeHasLeft) {
  const MapStep::Result written = change(with_box);
  EXPECT_EQ(written.provisional, step.provisional_numbers());
  const std::uint32_t last = step.revision();
  step = MapStep{settings, {.map = step.map(), .revision = last, .provisional = step.provisional()}};
  const MapStep::Result result = withdraw(Timestamp::min(), 1.0);
  ASSERT_TRUE(result.revision);
  EXPECT_EQ(*step.map(), hall);
  EXPECT_EQ(result.note.withdraws.back(), last);
  EXPECT_TRUE(result.provisional.empty());
}

TEST_F(Withdrawal, LeavesWhatTheRunBeforeHasLeftOnceItIsSettled) {
  (void)change(with_box);
  step = MapStep{settings, {.map = step.map(), .revision = step.revision(), .provisional = step.provisional()}};
  EXPECT_FALSE(step.take(Settlement{at(time_s + 40.0)}));
  EXPECT_FALSE(withdraw(Timestamp::min(), 41.0).revision);
}

TEST_F(Withdrawal, WhatLiesInAFrozenZoneIsNeverWritten) {
  const Polygon around{{8.5, 7.5}, {11.5, 7.5}, {11.5, 9.0}, {8.5, 9.0}};
  step.set_zones({{.id = "F", .kind = ZoneKind::kFrozen, .polygon = around}});
  test::DrawnScanParams noise;
  bool was_refused = false;
  for (int scan = 0; scan < 600; ++scan, time_s += 0.2) {
    const Pose2 pose = test::below_the_containers(time_s);
    const auto request = store_scan.observe(test::drawn_scan(with_box, step.map(), pose, time_s, random, noise));
    if (!request) continue;
    const std::optional<MapStep::Result> result = step.take(*request);
    was_refused = was_refused || (result && result->note.reason == "in a zone that is never written");
  }
  EXPECT_TRUE(was_refused) << "sets came, as evidence did not know of the zone";
  for (const CellChange& change : changes_between(hall, *step.map()))
    EXPECT_FALSE(contains(around, hall.geometry().centre_of(change.cell)));
}

TEST_F(Withdrawal, IsNotDoneTwice) {
  (void)change(with_box);
  (void)withdraw(Timestamp::min(), 1.0);
  EXPECT_FALSE(withdraw(Timestamp::min(), 2.0).revision);
}

TEST_F(Withdrawal, StandsInTheMapStore) {
  const test::TemporaryFolder folder;
  mapping::store::MapStore store{folder.path() / "store.sqlite", hall};
  keep(store, change(with_box), step.method());
  EXPECT_EQ(store.provisional(), step.provisional_numbers());
  ASSERT_EQ(store.newest(), step.revision());
  keep(store, withdraw(Timestamp::min(), 1.0), step.method());
  EXPECT_EQ(store.history().back().note.cause, "withdrawn");
  EXPECT_EQ(store.grid(store.newest()), hall);
  EXPECT_TRUE(store.provisional().empty());
}

TEST_F(Withdrawal, ASetOfADoubtfulPoseIsRefusedByName) {
  ScanSet set;
  set.pose_in_doubt = true;
  const MapStep::Result result = *step.take(set);
  EXPECT_FALSE(result.revision);
  EXPECT_EQ(result.note.reason, "pose in doubt");
}

}  // namespace
}  // namespace deltamap::daemon
