// SPDX-License-Identifier: Apache-2.0
// What becomes a set by evidence and what does not, through store-scan and with a map that follows.
#include "mapping/evidence/evidence_phase.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "tests/mapping/mapped_drive.hpp"

namespace deltamap::mapping::evidence {
namespace {

TEST(EvidencePhase, ShowsTheScansOfASetWhileItIsCollectedAndWhileItWaits) {
  MappedDrive drive{hall()};
  std::size_t collected = 0;
  std::size_t waiting = 0;
  drive.through(
      [&](double) {
        const StoredScans stored = drive.store.stored();
        collected = std::max(collected, stored.collected.size());
        waiting = std::max(waiting, stored.waiting.size());
        return hall_with({9.0, 8.0}, {11.0, 8.5}, CellState::kOccupied);
      },
      30.0);
  ASSERT_GE(drive.revisions, 1);
  EXPECT_GE(collected, 2u);
  EXPECT_LE(collected, 40u);
  EXPECT_GE(waiting, 2u);
  drive.through(always(*drive.map), 20.0);
  EXPECT_EQ(drive.store.stored(), StoredScans{}) << "nothing differs from the map any more";
}

/// A pose that has drifted over new ground draws on there, and says nothing of what was known before.
TEST(EvidencePhase, LeavesKnownGroundAloneByAPoseThatRestsOnNewGround) {
  const OccupancyGrid with_box = hall_with({9.0, 8.0}, {11.0, 8.5}, CellState::kOccupied);
  for (const bool is_known : {true, false}) {
    MappedDrive drive{is_known ? hall() : hall_with({8.0, 7.5}, {12.0, 9.5}, CellState::kUnknown)};
    drive.is_on_new_ground = true;
    drive.through(always(with_box), 30.0);
    EXPECT_EQ(drive.revisions == 0, is_known) << drive.revisions;
  }
}

TEST(EvidencePhase, IgnoresAPersonWhoWalks) {
  MappedDrive drive{hall()};
  drive.through(
      [](double time_s) {
        const double x = 6.5 + std::fmod(time_s * 0.8, 7.0);
        return hall_with({x, 7.5}, {x + 0.35, 7.8}, CellState::kOccupied);
      },
      60.0);
  EXPECT_EQ(count_of(*drive.map, CellState::kOccupied), count_of(hall(), CellState::kOccupied));
}

TEST(EvidencePhase, IgnoresADoorThatFlickers) {
  MappedDrive drive{hall()};
  drive.through(
      [](double time_s) {
        const bool open = std::fmod(time_s, 4.0) < 2.0;
        return open ? hall() : hall_with({9.0, 7.9}, {10.0, 7.95}, CellState::kOccupied);
      },
      60.0);
  EXPECT_EQ(drive.revisions, 0);
}

TEST(EvidencePhase, CountsForAParkedRobotByTime) {
  MappedDrive drive{hall()};
  drive.through(always(hall_with({11.0, 8.0}, {13.0, 8.4}, CellState::kOccupied)), 12.0, 0.0);
  EXPECT_GE(drive.revisions, 1);
}

constexpr double kNever_s = 80.0;
constexpr double kBetweenScans_s = 0.2;

/// When a parked robot hands on its first set of a box that becomes wider at that time.
double first_set_s(const EvidencePhaseParams& params, double wider_at_s, const OccupancyGrid& known = hall()) {
  EvidencePhase phase{params};
  Random random{5};
  const auto map = std::make_shared<const OccupancyGrid>(known);
  const OccupancyGrid narrow = hall_with({11.0, 8.0}, {12.0, 8.4}, CellState::kOccupied);
  const OccupancyGrid wide = hall_with({11.0, 8.0}, {13.0, 8.4}, CellState::kOccupied);
  for (double time_s = 0.0; time_s < kNever_s; time_s += kBetweenScans_s) {
    const OccupancyGrid& world = time_s < wider_at_s ? narrow : wide;
    const Pose2 pose = test::below_the_containers(time_s, 0.0);
    if (phase.observe(test::drawn_scan(world, map, pose, time_s, random))) return time_s;
  }
  return kNever_s;
}

TEST(EvidencePhase, HandsARegionOnOnceItHasCeasedToGrowOrHasWaitedTooLong) {
  constexpr double kWiderAt_s = 2.0;  // what is new is proven seconds later, while the rest waits
  constexpr double kLonger_s = 5.0;
  EvidencePhaseParams params;
  params.settle_s = params.most_wait_s = 20.0;
  const double from_the_oldest_s = first_set_s(params, kWiderAt_s);
  EXPECT_GT(from_the_oldest_s, params.most_wait_s);
  params.most_wait_s += kLonger_s;
  EXPECT_NEAR(first_set_s(params, kWiderAt_s), from_the_oldest_s + kLonger_s, 1.0);
  params.most_wait_s = kNever_s;
  const double from_the_newest_s = first_set_s(params, kWiderAt_s);
  EXPECT_GT(from_the_newest_s, from_the_oldest_s + kLonger_s);
  EXPECT_LT(from_the_newest_s, kNever_s);
}

TEST(EvidencePhase, HandsOnAtOnceWhatLiesWhereNothingWasKnown) {
  const OccupancyGrid unknown_there = hall_with({10.0, 7.5}, {14.0, 9.5}, CellState::kUnknown);
  EvidencePhaseParams params;
  params.settle_s = params.most_wait_s = 20.0;
  const double known_s = first_set_s(params, 0.0);
  const double unknown_s = first_set_s(params, 0.0, unknown_there);
  EXPECT_LT(unknown_s, known_s - 15.0);
  params.draws_at_once_s = params.settle_s;
  EXPECT_GT(first_set_s(params, 0.0, unknown_there), params.settle_s);
}

TEST(EvidencePhase, SaysNothingWhileThePoseIsLost) {
  StoreScan store{StoreScanParams{}, 1};
  Random random{5};
  const auto map = std::make_shared<const OccupancyGrid>(hall());
  const OccupancyGrid world = hall_with({9.0, 8.0}, {11.0, 8.5}, CellState::kOccupied);
  for (int i = 0; i < 100; ++i) {
    TrackedScan tracked = test::drawn_scan(world, map, {8.0, 6.8, 0.4}, 0.2 * i, random);
    tracked.estimate.state = LocalizerState::kLost;
    EXPECT_FALSE(store.observe(tracked));
  }
}

}  // namespace
}  // namespace deltamap::mapping::evidence
