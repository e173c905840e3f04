// SPDX-License-Identifier: Apache-2.0
// What is written for the set that a container has led to.
#include "mapping/redraw/evidence_update.hpp"

#include <gtest/gtest.h>

#include <memory>

#include "tests/mapping/mapped_drive.hpp"
#include "tests/support/scans/kept_scans.hpp"

namespace deltamap::mapping::redraw {
namespace {

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
  const scan_set::MapUpdate update = evidence_update(map, set, {});
  ASSERT_TRUE(update.accepted());
  EXPECT_GT(update.acceptance, 0.95);
  for (const CellChange& change : update.changes) {
    EXPECT_TRUE((CellBox{{195, 175}, {250, 200}}).contains(change.cell));  // the box's place in cells, and 0.5 m
  }
}

TEST_F(EvidenceUpdate, BringsDisplacedScansBackOntoTheMap) {
  const scan_set::MapUpdate straight = evidence_update(map, set, {});
  test::change_each(set.scans, [](TrackedScan& tracked) { tracked.estimate.map_from_robot.y -= 0.08; });
  const scan_set::MapUpdate displaced = evidence_update(map, set, {});
  ASSERT_TRUE(displaced.accepted());
  EXPECT_NEAR(mean_y_of_new_m(displaced), mean_y_of_new_m(straight), 0.03);
}

TEST_F(EvidenceUpdate, RefusesScansThatContradictTheirOwnPoses) {
  test::change_each(set.scans, [](TrackedScan& tracked) {
    tracked.estimate.map_from_robot.y -= 0.25;
    tracked.estimate.covariance = Eigen::Vector3d{1e-6, 1e-6, 1e-6}.asDiagonal();
  });
  const scan_set::MapUpdate update = evidence_update(map, set, {});
  EXPECT_EQ(update.refusal, scan_set::Refusal::kImplausible);
  EXPECT_TRUE(update.changes.empty());
}

TEST_F(EvidenceUpdate, RefusesASingleScan) {
  set.scans.resize(1);
  EXPECT_EQ(evidence_update(map, set, {}).refusal, scan_set::Refusal::kTooFewScans);
}

TEST_F(EvidenceUpdate, FindsNothingToDoTwice) {
  const scan_set::MapUpdate once = evidence_update(map, set, {});
  const scan_set::MapUpdate twice = evidence_update(patched(map, once.changes), set, {});
  EXPECT_EQ(twice.refusal, scan_set::Refusal::kNothingChanged);
}

}  // namespace
}  // namespace deltamap::mapping::redraw
