// SPDX-License-Identifier: Apache-2.0
// What one thread hands from stage to stage: here a revision, on its way back to the localizer.
#include "daemon/replay/sequential_run.hpp"

#include <gtest/gtest.h>

#include "tests/support/worlds/drawn_hall.hpp"

namespace deltamap::daemon {
namespace {

Timestamp at(double time_s) { return Timestamp{} + duration_from_seconds(time_s); }

/// A cell in the middle of the hall becomes occupied, by an operator, at this time.
SetCells one_cell(const OccupancyGrid& map, double time_s) {
  SetCells wanted;
  wanted.order.scan_time = at(time_s);
  wanted.width = map.geometry().width;
  wanted.height = map.geometry().height;
  const Cell cell = map.geometry().cell_at({2.0, 2.0});
  wanted.changes = {{cell, map[cell], CellState::kOccupied}};
  return wanted;
}

/// The number of the map that a scan of this time is localized on.
std::uint32_t revision_at(SequentialRun& run, double time_s) {
  Scan scan;
  scan.time = at(time_s);
  run.take_what_is_due(scan);
  return run.observe(scan).estimate.revision;
}

SequentialRun run_with_delay(const std::shared_ptr<const OccupancyGrid>& map, double delay_s) {
  return {Settings{}, {map}, nullptr, delay_s};
}

TEST(SequentialRun, LocalizesOnARevisionOnceItsDelayHasPassed) {
  const auto map = std::make_shared<const OccupancyGrid>(test::drawn_hall(0.05));
  SequentialRun run = run_with_delay(map, 1.0);
  EXPECT_EQ(revision_at(run, 10.0), 0u);
  ASSERT_TRUE(run.obey(one_cell(*map, 10.0)).revision);
  EXPECT_EQ(revision_at(run, 10.5), 0u);
  EXPECT_EQ(revision_at(run, 11.0), 1u);
}

TEST(SequentialRun, WithoutADelayLocalizesOnItFromTheNextScanOn) {
  const auto map = std::make_shared<const OccupancyGrid>(test::drawn_hall(0.05));
  SequentialRun run = run_with_delay(map, 0.0);
  ASSERT_TRUE(run.obey(one_cell(*map, 10.0)).revision);
  EXPECT_EQ(revision_at(run, 10.1), 1u);
}

TEST(SequentialRun, AsksNothingOfTheMapWhereNothingIsInView) {
  const auto map = std::make_shared<const OccupancyGrid>(test::drawn_hall(0.05));
  SequentialRun run = run_with_delay(map, 0.0);
  Scan scan;
  scan.time = at(1.0);
  EXPECT_FALSE(run.look_for_changes(run.observe(scan)));
}

}  // namespace
}  // namespace deltamap::daemon
