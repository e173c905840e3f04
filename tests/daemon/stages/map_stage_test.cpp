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

TEST(MapStage, ARevisionIsServedBeforeAnyPoseCanNameIt) {
  const Settings settings;
  const auto hall = std::make_shared<const OccupancyGrid>(test::drawn_hall(0.05));
  Channel<MapWork> work{8};
  Channel<MapRevision> revisions{8};
  RecorderInput recorder{8};
  Telemetry telemetry;
  ThingsBoard things;
  const BaysBoard bays;
  std::uint32_t served = 0;
  bool was_handed_on_before = false;
  MapStage stage{settings,
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
                  .show =
                      [&](const MapRevision* revision, const ChangeNote&) {
                        was_handed_on_before = was_handed_on_before || revisions.try_receive().has_value();
                        if (revision != nullptr) served = revision->number;
                      },
                  .answer = [](const control::CommandOutcome&) {},
                  .things = things,
                  .bays = bays}};
  auto set = set_with_a_box(hall, settings);
  ASSERT_TRUE(set);
  ASSERT_TRUE(work.try_send(MapWork{*std::move(set)}));
  work.close();
  stage.run({});
  EXPECT_EQ(served, 1u);
  EXPECT_FALSE(was_handed_on_before) << "the localizer had it before the page";
  const auto handed_on = revisions.try_receive();
  ASSERT_TRUE(handed_on);
  EXPECT_EQ(handed_on->number, 1u);
}

}  // namespace
}  // namespace deltamap::daemon
