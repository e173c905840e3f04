// SPDX-License-Identifier: Apache-2.0
// Merges that once went wrong in `deltamap-lab merge`.
#include <gtest/gtest.h>

#include "core/geometry/angle.hpp"
#include "experiments/merge/merge_places.hpp"
#include "mapping/registration/transformed_grid.hpp"
#include "surveying/grid_registration/global_merge.hpp"
#include "surveying/grid_registration/prior_merge.hpp"

namespace deltamap::experiments {
namespace {

constexpr double kRight_cells = 0.5;

TEST(GlobalMerge, FindsTheTruePlaceAmongRacksThatRepeat) {
  const MergePlace place = drawn_place("racks", 2000);
  Random random{2000};
  for (int i = 0; i < 7; ++i) {
    const LocalMap local = turned_local(place, false, random);
    if (i != 0 && i != 6) continue;
    const mapping::merge::MapMerge merge = surveying::grid_registration::global_merge(place.map, local.grid);
    EXPECT_TRUE(merge.accepted()) << i;
    EXPECT_LT(measured(place, local, merge.map_from_local).off_cells, kRight_cells) << i;
  }
}

TEST(PriorMerge, DoesNotAskForSurfacesWhereTheMapKnowsNothing) {
  const MergePlace place =
      drawn_place("racks", 11001);  // more than half of the local map's posts stand outside the map
  Random random{11004};
  const PoseCovariance covariance = Eigen::Vector3d{0.01, 0.01, 0.001}.asDiagonal();
  for (int i = 0; i < 3; ++i) {
    const LocalMap local = turned_local(place, false, random);
    const Pose2 truth = place.map_from_other * inverse(local.local_from_other);
    const auto merge = surveying::grid_registration::prior_merge(place.map, local.grid, truth, covariance, {});
    EXPECT_TRUE(merge.accepted()) << i;
    EXPECT_LT(measured(place, local, merge.map_from_guess * truth).off_cells, kRight_cells) << i;
  }
}

TEST(PriorMerge, EndsAsWellAsTheTruePoseNearTheLatticesOwnTurns) {
  const MergePlace place = drawn_place("offices", 2000);
  const PoseCovariance covariance = Eigen::Vector3d{0.01, 0.01, 0.001}.asDiagonal();
  for (const double turn_deg : {-179.62, -90.12, 179.25, 0.7, 134.86}) {
    const Pose2 local_from_map{0.43, -0.27, radians(turn_deg)};
    const OccupancyGrid local = mapping::registration::moved_grid(place.map, local_from_map, place.map.resolution_m());
    const mapping::merge::LocalCells cells{local};
    const auto merge =
        surveying::grid_registration::prior_merge(place.map, local, inverse(local_from_map), covariance, {});
    ASSERT_TRUE(merge.accepted()) << turn_deg;
    const Pose2 found = merge.map_from_guess * inverse(local_from_map);
    const auto motion = mapping::merge::cell_motion(found, place.map.geometry(), cells);
    EXPECT_GE(place.overlay.score(cells, motion).acceptance(), 0.999) << turn_deg;
  }
}

}  // namespace
}  // namespace deltamap::experiments
