// SPDX-License-Identifier: Apache-2.0
#include "mapping/merge/axis_spectrum.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "tests/support/worlds/drawn_grid.hpp"

namespace deltamap::mapping::merge {
namespace {

TEST(AxisSpectra, CountTheContourByColumnAndRow) {
  const AxisSpectra spectra = axis_spectra(test::drawn_grid({"....",  //
                                                             ".##.",  //
                                                             ".#.."}),
                                           1);
  EXPECT_EQ(spectra.x.first, 1);
  EXPECT_EQ(spectra.x.counts, (std::vector<float>{2.0F, 1.0F}));
  EXPECT_EQ(spectra.y.first, 0);
  EXPECT_EQ(spectra.y.counts, (std::vector<float>{1.0F, 2.0F}));
}

TEST(AxisSpectra, DrawACellSoManyPixelsWideAboutItsCentre) {
  const AxisSpectra map = axis_spectra(test::drawn_grid({"....",  //
                                                         ".#..",  //
                                                         "...."}),
                                       2);
  EXPECT_EQ(map.x.first, 2);
  EXPECT_EQ(map.x.counts, (std::vector<float>{1.0F, 1.0F}));
  const std::vector<PointInCells> centre{{1.5F, 0.75F}};
  const AxisSpectra local = axis_spectra(centre, 0.0, 2);
  EXPECT_EQ(local.x.first, 2);
  EXPECT_EQ(local.x.counts, (std::vector<float>{1.0F, 1.0F}));
  EXPECT_EQ(local.y.first, 1) << "three quarters of a cell: half a cell from the row that it lies in";
}

TEST(BestShifts, FindTheShiftBetweenTwoSpectra) {
  const AxisSpectrum one{0, {0.0, 0.0, 0.0, 5.0, 1.0, 0.0, 2.0, 0.0}};
  const AxisSpectrum other{-4, {5.0, 1.0, 0.0, 2.0}};
  EXPECT_EQ(best_shifts(one, other, 1, 3), std::vector<int>{7});
  EXPECT_TRUE(best_shifts(one, {}, 3, 3).empty());
}

}  // namespace
}  // namespace deltamap::mapping::merge
