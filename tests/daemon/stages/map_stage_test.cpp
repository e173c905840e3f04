// SPDX-License-Identifier: Apache-2.0
#include "daemon/stages/map_stage.hpp"

#include <gtest/gtest.h>

#include "mapping/store_scan.hpp"
#include "tests/support/scans/drawn_scan.hpp"
#include "tests/support/worlds/drawn_hall.hpp"

namespace deltamap::daemon {
namespace {

/// A box has appeared in a hall: the set that draws it.
std::optional<MapRequest> set_with_a_box(const std::shared_ptr<const OccupancyGrid>& hall, const Settings& settings) {
  OccupancyGrid world = *hall;
  test::fill(world, {9.0, 8.0}, {11.0, 8.5}, CellState::kOccupied);
  mapping::StoreScan store_scan{settings.mapping.store_scan, 1};
  Random random{5};
  for (double time_s = 0.0; time_s < 120.0; time_s += 0.2) {
    const Pose2 pose = test::below_the_containers(time_s);
    auto request = store_scan.observe(test::drawn_scan(world, hall, pose, time_s, random, {}));
    if (request && std::holds_alternative<ScanSet>(*request)) return request;
  }
  return std::nullopt;
}

/// A map thread in a hall, its ends in hand.
struct StageInAHall {
  explicit StageInAHall(std::function<void(const MapRevision*)> show = [](const MapRevision*) {})
      : stage{settings,
              {.map = hall},
              grid_hash(*hall),
              std::nullopt,
              {},
              {.work = work,
               .revisions = revisions,
               .recorder = recorder,
               .telemetry = telemetry,
               .log = [](const std::string&) {},
               .warn = [](const std::string&) {},
               .show = [show](const MapRevision* revision, const ChangeNote&) { show(revision); },
               .answer = [](const control::CommandOutcome&) {},
               .things = things,
               .bays = bays}} {}

  Settings settings;
  std::shared_ptr<const OccupancyGrid> hall = std::make_shared<const OccupancyGrid>(test::drawn_hall(0.05));
  Channel<MapWork> work{8};
  Channel<MapRevision> revisions{8};
  RecorderInput recorder{8};
  Telemetry telemetry;
  ThingsBoard things;
  BaysBoard bays;
  MapStage stage;
};

TEST(MapStage, ARevisionIsServedBeforeAnyPoseCanNameIt) {
  std::uint32_t served = 0;
  bool was_handed_on_before = false;
  Channel<MapRevision>* handed_on_to = nullptr;
  StageInAHall one{[&](const MapRevision* revision) {
    was_handed_on_before = was_handed_on_before || handed_on_to->try_receive().has_value();
    if (revision != nullptr) served = revision->number;
  }};
  handed_on_to = &one.revisions;
  auto set = set_with_a_box(one.hall, one.settings);
  ASSERT_TRUE(set);
  ASSERT_TRUE(one.work.try_send(MapWork{*std::move(set)}));
  one.work.close();
  one.stage.run({});
  EXPECT_EQ(served, 1u);
  EXPECT_FALSE(was_handed_on_before) << "the localizer had it before the page";
  const auto handed_on = one.revisions.try_receive();
  ASSERT_TRUE(handed_on);
  EXPECT_EQ(handed_on->number, 1u);
}

TEST(MapStage, WhatAZoneForbidsIsRefusedAndLeavesNoStaleMap) {
  StageInAHall one;
  auto set = set_with_a_box(one.hall, one.settings);
  ASSERT_TRUE(set);
  const Zone everywhere{.id = "Z", .polygon = {{0.0, 0.0}, {100.0, 0.0}, {100.0, 100.0}, {0.0, 100.0}}};
  ASSERT_TRUE(one.work.try_send(MapWork{std::make_shared<const Site>(Site{{}, {everywhere}})}));
  ASSERT_TRUE(one.work.try_send(MapWork{*std::move(set)}));
  one.work.close();
  one.stage.run({});
  EXPECT_EQ(one.telemetry.refused.value(), 1u);
  EXPECT_EQ(one.telemetry.stale_refusals.value(), 0u);
}

TEST(MapStage, ASetWhosePoseIsInDoubtLeavesTheMapStale) {
  StageInAHall one;
  auto set = set_with_a_box(one.hall, one.settings);
  ASSERT_TRUE(set);
  std::get<ScanSet>(*set).pose_in_doubt = true;
  ASSERT_TRUE(one.work.try_send(MapWork{*std::move(set)}));
  one.work.close();
  one.stage.run({});
  EXPECT_EQ(one.telemetry.refused.value(), 1u);
  EXPECT_EQ(one.telemetry.stale_refusals.value(), 1u);
}

}  // namespace
}  // namespace deltamap::daemon
