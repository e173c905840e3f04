// SPDX-License-Identifier: Apache-2.0
#include "mapping/alignment/local_map.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "mapping/registration/acceptance.hpp"
#include "tests/support/scans/seen_scan.hpp"
#include "tests/support/worlds/drawn_hall.hpp"

namespace deltamap::mapping::alignment {
namespace {

TEST(LocalMap, DrawsWhatTheScansSawOnTheMapsLattice) {
  const OccupancyGrid hall = test::drawn_hall(0.05);
  Random random{7};
  std::vector<TrackedScan> scans;
  for (int i = 0; i < 24; ++i) scans.push_back(test::seen_scan(hall, {7.0 + 0.03 * i, 6.6, 0.27 * i}, 0.002, random));
  std::vector<const TrackedScan*> pointers;
  std::vector<Pose2> poses;
  for (const TrackedScan& scan : scans) {
    pointers.push_back(&scan);
    poses.push_back(scan.estimate.map_from_robot);
  }
  const OccupancyGrid local = local_map(pointers, poses, hall.geometry(), {});
  const double columns = (local.geometry().origin.x() - hall.geometry().origin.x()) / 0.05;
  EXPECT_NEAR(columns, std::round(columns), 1e-9);
  EXPECT_GT(registration::acceptance(local, hall).value(), 0.97);
  EXPECT_GT(registration::surface_agreement(hall, local, {}), 0.99);
}

TEST(LocalMap, FreesNothingAlongBeamsWithoutRange) {
  TrackedScan blind;
  blind.scan.beams.assign(3, Beam{0.0F, 0.0F, BeamKind::kBeyondMaximum});
  blind.rays.assign(3, RayInRobot{{0.0F, 0.0F}, {5.0F, 0.0F}});
  const TrackedScan* scan = &blind;
  const Pose2 pose;
  const OccupancyGrid local = local_map({&scan, 1}, {&pose, 1}, {10, 10, 0.1, {0.0, 0.0}}, {});
  EXPECT_EQ(count_of(local, CellState::kFree), 0U);
}

}  // namespace
}  // namespace deltamap::mapping::alignment
