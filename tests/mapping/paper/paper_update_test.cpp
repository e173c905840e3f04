// SPDX-License-Identifier: Apache-2.0
#include "mapping/paper/paper_update.hpp"

#include <gtest/gtest.h>

#include <ctime>

#include "mapping/map_update.hpp"
#include "mapping/map_update_params.hpp"
#include "mapping/registration/contour_score.hpp"
#include "tests/support/scans/kept_scans.hpp"
#include "tests/support/scans/seen_scan.hpp"
#include "tests/support/worlds/drawn_hall.hpp"

namespace deltamap::mapping::paper {
namespace {

/// A Δ-phase: a robot turns and drives past the middle of the hall; the localizer errs by what it claims.
ScanSet phase_in(const OccupancyGrid& world, int scans, std::uint64_t seed, const Pose2& error = {}) {
  Random random{seed};
  ScanSet set;
  set.phase = 1;
  set.method = MappingMethod::kPaper;
  for (int i = 0; i < scans; ++i) {
    const double along = static_cast<double>(i) / scans;
    const Pose2 pose{5.0 + 8.0 * along, 6.8 + 0.4 * std::sin(6.0 * along), wrapped_angle(6.0 * along)};
    TrackedScan scan = test::seen_scan(world, pose, 0.01, random);
    const Pose2 about{9.0, 7.0, 0.0};
    scan.estimate.map_from_robot = about * error * inverse(about) * test::disturbed(pose, 0.03, 0.01, random);
    scan.estimate.covariance = Eigen::Vector3d{0.0009, 0.0009, 0.0001}.asDiagonal();
    set.scans.push_back(std::make_shared<const TrackedScan>(std::move(scan)));
  }
  return set;
}

OccupancyGrid changed_hall() {
  OccupancyGrid hall = test::drawn_hall(0.05);
  test::fill(hall, {8.0, 8.5}, {11.0, 10.0}, CellState::kFree);      // a container has gone
  test::fill(hall, {11.5, 4.0}, {12.7, 5.2}, CellState::kOccupied);  // another has come
  return hall;
}

TEST(PaperUpdate, WritesWhatHasChanged) {
  const OccupancyGrid before = test::drawn_hall(0.05);
  const OccupancyGrid after = changed_hall();
  const scan_set::MapUpdate update = paper_update(before, phase_in(after, 30, 1), {});
  ASSERT_TRUE(update.accepted()) << name_of(update.refusal);
  EXPECT_GT(update.acceptance, 0.95);
  const OccupancyGrid updated = patched(before, update.changes);
  // The faces that the robot saw: the lower side of the container that has gone, the upper side of the one that came.
  EXPECT_EQ(updated.at(before.geometry().cell_at({9.5, 8.6})), CellState::kFree);
  int found = 0;
  for (double x = 11.6; x < 12.6; x += 0.05) {
    for (double y = 5.0; y < 5.4; y += 0.05)
      found += updated.at(before.geometry().cell_at({x, y})) == CellState::kOccupied;
  }
  EXPECT_GE(found, 15);
}

TEST(PaperUpdate, IsTheBranchOfItsMethod) {
  const OccupancyGrid before = test::drawn_hall(0.05);
  const ScanSet set = phase_in(changed_hall(), 30, 1);
  EXPECT_EQ(map_update(before, set, {}).changes, paper_update(before, set, {}).changes);
}

TEST(PaperUpdate, RefusesTooFewScans) {
  const OccupancyGrid hall = test::drawn_hall(0.05);
  EXPECT_EQ(paper_update(hall, phase_in(hall, 2, 2), {}).refusal, scan_set::Refusal::kTooFewScans);
}

TEST(PaperUpdate, RefusesScansThatDoNotAlign) {
  const OccupancyGrid hall = test::drawn_hall(0.05);
  ScanSet set = phase_in(hall, 10, 3);
  Random random{4};
  test::change_each(set.scans, [&](TrackedScan& scan) {
    for (RayInRobot& ray : scan.rays) ray.end *= static_cast<float>(random.uniform(0.2, 1.0));
  });
  EXPECT_EQ(paper_update(hall, set, {}).refusal, scan_set::Refusal::kNoAlignment);
}

TEST(PaperUpdate, RefusesAMapOfAnotherPlace) {
  const OccupancyGrid hall = test::drawn_hall(0.05);
  OccupancyGrid other{hall.geometry(), CellState::kFree};
  for (double x = 0.0; x < 20.0; x += 1.7)
    test::fill(other, {x, 0.6 * x}, {x + 0.3, 0.6 * x + 0.3}, CellState::kOccupied);
  const scan_set::MapUpdate update = paper_update(other, phase_in(hall, 20, 5), {});
  EXPECT_EQ(update.refusal, scan_set::Refusal::kNoMerge);
  EXPECT_TRUE(update.changes.empty());
  EXPECT_EQ(paper_update(OccupancyGrid{hall.geometry()}, phase_in(hall, 20, 5), {}).refusal,
            scan_set::Refusal::kNoMerge);
}

TEST(PaperUpdate, RefusesAMergeThatContradictsTheLocalizerUnlessToldOtherwise) {
  const OccupancyGrid before = test::drawn_hall(0.05);
  const ScanSet misplaced = phase_in(changed_hall(), 30, 6, {1.5, 0.0, 0.2});
  EXPECT_EQ(paper_update(before, misplaced, {}).refusal, scan_set::Refusal::kImplausible);
  PaperUpdateParams as_published;
  as_published.refuse_implausible = false;
  EXPECT_TRUE(paper_update(before, misplaced, as_published).accepted());
}

TEST(PaperUpdate, RefusesBelowTheAcceptanceThreshold) {
  PaperUpdateParams params;
  params.least_acceptance = 0.9999;
  EXPECT_EQ(paper_update(test::drawn_hall(0.05), phase_in(changed_hall(), 20, 7), params).refusal,
            scan_set::Refusal::kLowAcceptance);
}

TEST(PaperUpdate, StaysWithinItsTimeForManyScans) {
  const OccupancyGrid before = test::drawn_hall(0.05);
  const ScanSet set = phase_in(changed_hall(), 150, 8);
  const std::clock_t start = std::clock();
  const scan_set::MapUpdate update = paper_update(before, set, {});
  const double seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  std::printf("150 scans: %.2f s CPU, acceptance %.4f\n", seconds, update.acceptance);
  EXPECT_TRUE(update.accepted()) << name_of(update.refusal);
  EXPECT_LT(seconds, 30.0);
}

}  // namespace
}  // namespace deltamap::mapping::paper
