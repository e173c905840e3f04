// SPDX-License-Identifier: Apache-2.0
// The evidence method from scans to map in a drawn hall: the world changes, the robot drives by, the map follows.
#include <gtest/gtest.h>

#include <functional>
#include <memory>

#include "core/random.hpp"
#include "mapping/map_update.hpp"
#include "mapping/map_update_params.hpp"
#include "mapping/store_scan.hpp"
#include "tests/support/scans/drawn_scan.hpp"
#include "tests/support/scans/kept_scans.hpp"
#include "tests/support/scans/map_requests.hpp"
#include "tests/support/worlds/drawn_hall.hpp"

namespace deltamap::mapping {
namespace {

using World = std::function<OccupancyGrid(double time_s)>;

/// Drives to and fro below the containers of the hall, and lets the map follow.
class Drive {
 public:
  explicit Drive(OccupancyGrid first) : map{std::make_shared<const OccupancyGrid>(std::move(first))} {
    noise.position_deviation_m = 0.02;
    noise.heading_deviation_rad = 0.004;
  }

  void through(const World& world, double duration_s, double speed_m_per_s = 0.4) {
    constexpr double kPeriod_s = 0.2;
    for (double t = 0.0; t < duration_s; t += kPeriod_s, time_s += kPeriod_s) {
      const double way_m = std::fmod(time_s * speed_m_per_s, 10.0);
      const Pose2 pose{way_m < 5.0 ? 7.5 + way_m : 17.5 - way_m, 6.8, way_m < 5.0 ? 0.4 : 2.7};
      const auto set = test::set_in(store.observe(test::drawn_scan(world(time_s), map, pose, time_s, random, noise)));
      if (!set) continue;
      const scan_set::MapUpdate update = map_update(*map, *set, {});
      if (!update.accepted()) continue;
      ++revisions;
      map = std::make_shared<const OccupancyGrid>(patched(*map, update.changes));
    }
  }

  std::shared_ptr<const OccupancyGrid> map;
  StoreScan store{StoreScanParams{}, 1};
  Random random{5};
  test::DrawnScanParams noise;
  double time_s = 0.0;
  int revisions = 0;
};

OccupancyGrid hall() { return test::drawn_hall(0.05); }
OccupancyGrid hall_with(Point2 low, Point2 high, CellState state) {
  OccupancyGrid grid = hall();
  test::fill(grid, low, high, state);
  return grid;
}
World always(OccupancyGrid grid) {
  return [grid = std::move(grid)](double) { return grid; };
}

double occupied_share(const OccupancyGrid& map, Point2 low, Point2 high) {
  const Cell first = map.geometry().cell_at(low);
  const Cell last = map.geometry().cell_at(high);
  int occupied = 0;
  int all = 0;
  for (int row = first.row; row <= last.row; ++row) {
    for (int column = first.column; column <= last.column; ++column, ++all) {
      occupied += map[{column, row}] == CellState::kOccupied ? 1 : 0;
    }
  }
  return static_cast<double>(occupied) / all;
}

/// Share of the columns between the two corners that have an occupied cell between them.
double drawn_share(const OccupancyGrid& map, Point2 low, Point2 high) {
  int drawn = 0;
  int all = 0;
  for (double x = low.x(); x <= high.x(); x += map.resolution_m(), ++all) {
    drawn += occupied_share(map, {x, low.y()}, {x, high.y()}) > 0.0 ? 1 : 0;
  }
  return static_cast<double>(drawn) / all;
}

TEST(Evidence, LeavesAMapAloneThatIsRight) {
  Drive drive{hall()};
  drive.through(always(hall()), 60.0);
  EXPECT_EQ(drive.revisions, 0);
  EXPECT_EQ(*drive.map, hall());
}

TEST(Evidence, WritesAContainerThatHasCome) {
  Drive drive{hall()};
  drive.through(always(hall_with({9.0, 8.0}, {11.0, 8.5}, CellState::kOccupied)), 30.0);
  EXPECT_GE(drive.revisions, 1);
  EXPECT_GT(drawn_share(*drive.map, {9.05, 7.97}, {10.95, 8.07}), 0.9);  // its face, give or take a cell
  EXPECT_EQ(occupied_share(*drive.map, {9.0, 7.0}, {11.0, 7.8}), 0.0);
}

TEST(Evidence, ShowsTheScansOfASetWhileItIsCollectedAndWhileItWaits) {
  Drive drive{hall()};
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
  drive.through(always(*drive.map), 10.0);
  EXPECT_EQ(drive.store.stored(), StoredScans{}) << "nothing differs from the map any more";
}

TEST(Evidence, FreesWhereAContainerHasGone) {
  Drive drive{hall()};
  drive.through(always(hall_with({8.0, 8.5}, {11.0, 10.0}, CellState::kFree)), 40.0);
  EXPECT_GE(drive.revisions, 1);
  EXPECT_LT(occupied_share(*drive.map, {8.2, 8.5}, {10.8, 8.6}), 0.1);  // the face that was seen through
}

TEST(Evidence, TakesBackWhatHasComeAndGone) {
  Drive drive{hall()};
  const Point2 low{9.0, 8.0};
  const Point2 high{11.0, 8.5};
  drive.through(always(hall_with(low, high, CellState::kOccupied)), 30.0);
  ASSERT_GT(drawn_share(*drive.map, {9.05, 7.97}, {10.95, 8.07}), 0.9);
  drive.through(always(hall()), 40.0);
  EXPECT_LT(occupied_share(*drive.map, {9.05, 7.9}, {10.95, 8.3}), 0.05);
}

TEST(Evidence, IgnoresAPersonWhoWalks) {
  Drive drive{hall()};
  drive.through(
      [](double time_s) {
        const double x = 6.5 + std::fmod(time_s * 0.8, 7.0);
        return hall_with({x, 7.5}, {x + 0.35, 7.8}, CellState::kOccupied);
      },
      60.0);
  EXPECT_EQ(count_of(*drive.map, CellState::kOccupied), count_of(hall(), CellState::kOccupied));
}

TEST(Evidence, DrawsAPersonWhoStandsForMinutesAndFreesHimWithinSeconds) {
  Drive drive{hall()};
  const auto drawn = [&] {
    return count_of(*drive.map, CellState::kOccupied) - count_of(hall(), CellState::kOccupied);
  };
  drive.through(always(hall_with({10.0, 7.5}, {10.35, 7.8}, CellState::kOccupied)), 110.0);
  EXPECT_EQ(drawn(), 0);
  drive.through(always(hall_with({10.0, 7.5}, {10.35, 7.8}, CellState::kOccupied)), 60.0);
  EXPECT_GT(drawn(), 3);
  drive.through(always(hall()), 15.0);
  EXPECT_EQ(drawn(), 0);
}

TEST(Evidence, IgnoresADoorThatFlickers) {
  Drive drive{hall()};
  drive.through(
      [](double time_s) {
        const bool open = std::fmod(time_s, 4.0) < 2.0;
        return open ? hall() : hall_with({9.0, 7.9}, {10.0, 7.95}, CellState::kOccupied);
      },
      60.0);
  EXPECT_EQ(drive.revisions, 0);
}

TEST(Evidence, DoesNotErodeWallsWherePosesAreNoisy) {
  Drive drive{hall()};
  drive.noise.position_deviation_m = 0.06;
  drive.noise.heading_deviation_rad = 0.015;
  drive.noise.range_deviation_m = 0.02;
  drive.through(always(hall()), 120.0);
  std::size_t gone = 0;
  for (const CellChange& change : changes_between(hall(), *drive.map))
    gone += change.before == CellState::kOccupied ? 1 : 0;
  EXPECT_EQ(gone, 0u);
}

TEST(Evidence, CountsForAParkedRobotByTime) {
  Drive drive{hall()};
  drive.through(always(hall_with({11.0, 8.0}, {13.0, 8.4}, CellState::kOccupied)), 12.0, 0.0);
  EXPECT_GE(drive.revisions, 1);
}

TEST(Evidence, SaysNothingWhileThePoseIsLost) {
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

TEST(Evidence, GivesTheSameMapForTheSameScans) {
  const auto run = [] {
    Drive drive{hall()};
    drive.through(always(hall_with({9.0, 8.0}, {11.0, 8.5}, CellState::kOccupied)), 30.0);
    return grid_hash(*drive.map);
  };
  EXPECT_EQ(run(), run());
}

class EvidenceUpdate : public testing::Test {
 protected:
  /// The set that the box leads to, and the map that it was seen on.
  EvidenceUpdate() {
    const OccupancyGrid world = hall_with({9.0, 8.0}, {11.0, 8.5}, CellState::kOccupied);
    StoreScan store{StoreScanParams{}, 1};
    Random random{5};
    const auto shared = std::make_shared<const OccupancyGrid>(map);
    for (int i = 0; i < 100 && set.scans.empty(); ++i) {
      const auto found =
          test::set_in(store.observe(test::drawn_scan(world, shared, {8.0 + 0.05 * i, 6.8, 0.4}, 0.2 * i, random)));
      if (found) set = *found;
    }
  }
  /// Where the cells that the update draws lie.
  double mean_y_of_new_m(const scan_set::MapUpdate& update) {
    double sum_m = 0.0;
    int count = 0;
    for (const CellChange& change : update.changes) {
      if (change.after != CellState::kOccupied) continue;
      sum_m += map.geometry().centre_of(change.cell).y();
      ++count;
    }
    return sum_m / count;
  }
  OccupancyGrid map = hall();
  ScanSet set;
};

TEST_F(EvidenceUpdate, WritesOnlyAroundTheVerdicts) {
  ASSERT_FALSE(set.verdicts.empty());
  const scan_set::MapUpdate update = map_update(map, set, {});
  ASSERT_TRUE(update.accepted());
  EXPECT_GT(update.acceptance, 0.95);
  for (const CellChange& change : update.changes) {
    EXPECT_TRUE((CellBox{{195, 175}, {250, 200}}).contains(change.cell));  // the box's place in cells, and 0.5 m
  }
}

TEST_F(EvidenceUpdate, BringsDisplacedScansBackOntoTheMap) {
  const scan_set::MapUpdate straight = map_update(map, set, {});
  test::change_each(set.scans, [](TrackedScan& tracked) { tracked.estimate.map_from_robot.y -= 0.08; });
  const scan_set::MapUpdate displaced = map_update(map, set, {});
  ASSERT_TRUE(displaced.accepted());
  EXPECT_NEAR(mean_y_of_new_m(displaced), mean_y_of_new_m(straight), 0.03);
}

TEST_F(EvidenceUpdate, RefusesScansThatContradictTheirOwnPoses) {
  test::change_each(set.scans, [](TrackedScan& tracked) {
    tracked.estimate.map_from_robot.y -= 0.25;
    tracked.estimate.covariance = Eigen::Vector3d{1e-6, 1e-6, 1e-6}.asDiagonal();
  });
  const scan_set::MapUpdate update = map_update(map, set, {});
  EXPECT_EQ(update.refusal, scan_set::Refusal::kImplausible);
  EXPECT_TRUE(update.changes.empty());
}

TEST_F(EvidenceUpdate, RefusesASingleScan) {
  set.scans.resize(1);
  EXPECT_EQ(map_update(map, set, {}).refusal, scan_set::Refusal::kTooFewScans);
}

TEST_F(EvidenceUpdate, FindsNothingToDoTwice) {
  const scan_set::MapUpdate once = map_update(map, set, {});
  const scan_set::MapUpdate twice = map_update(patched(map, once.changes), set, {});
  EXPECT_EQ(twice.refusal, scan_set::Refusal::kNothingChanged);
}

}  // namespace
}  // namespace deltamap::mapping
