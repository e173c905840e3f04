// SPDX-License-Identifier: Apache-2.0
#include "mapping/merge/overlay_score.hpp"

#include <gtest/gtest.h>

#include "core/geometry/angle.hpp"
#include "mapping/registration/transformed_grid.hpp"
#include "tests/support/worlds/drawn_grid.hpp"
#include "tests/support/worlds/drawn_hall.hpp"

namespace deltamap::mapping::merge {
namespace {

TEST(OverlayScore, CountsByHandAndIgnoresUnknown) {
  const OccupancyGrid map = test::drawn_grid({"#. .",  //
                                              "..#."});
  const OccupancyGrid local = test::drawn_grid({"##.#",  //
                                                ". #."});
  const LocalCells cells{local};
  const OverlayScore score = OverlayMap{map}.score(cells, cell_motion({}, map.geometry(), cells));
  EXPECT_EQ(score.agreeing, 4.0);     // '#' at the upper left, '.', '#', '.' below
  EXPECT_EQ(score.disagreeing, 2.0);  // '#' on '.' twice in the upper row
  EXPECT_DOUBLE_EQ(score.acceptance(), 4.0 / 6.0);
  EXPECT_DOUBLE_EQ(score.overlap, 6.0 / 7.0);
  EXPECT_DOUBLE_EQ(score.surface_found, 1.0);
}

TEST(OverlayScore, EqualsTheAcceptanceOfWholeCellMotions) {
  const OccupancyGrid hall = test::drawn_hall();
  const Pose2 motion{1.3, -0.7, radians(90.0)};
  const LocalCells cells{hall};
  const OverlayScore score = OverlayMap{hall}.score(cells, cell_motion(motion, hall.geometry(), cells));
  const registration::Acceptance counts =
      registration::acceptance(registration::transformed_grid(hall, motion, hall.geometry()), hall);
  // The turned corner of a cell falls on a corner again, so that centres fall on centres.
  EXPECT_NEAR(score.agreeing, static_cast<double>(counts.agreeing), 0.001 * score.agreeing);
  EXPECT_NEAR(score.disagreeing, static_cast<double>(counts.disagreeing), 0.001 * score.agreeing);
}

}  // namespace
}  // namespace deltamap::mapping::merge
