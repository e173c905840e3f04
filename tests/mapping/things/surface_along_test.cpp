// SPDX-License-Identifier: Apache-2.0
#include "mapping/things/surface_along.hpp"

#include <gtest/gtest.h>

#include "tests/mapping/things/drawn_site.hpp"

namespace deltamap::mapping::things {
namespace {

TEST(SurfaceAlong, CountsThePlacesAtOrBesideASurface) {
  DrawnSite site;
  site.fill({4.0, 4.0, 4.95, 4.0}, CellState::kOccupied).begin_with_what_is_drawn();
  const SurfaceAlong on = surface_along(site.map, {4.01, 4.01}, {6.02, 4.01});
  EXPECT_EQ(on.all, 40);
  EXPECT_EQ(on.places, 21) << "one place beyond its end is a cell away";
  EXPECT_EQ(surface_along(site.map, {4.01, 4.06}, {6.02, 4.06}).places, 21) << "a cell beside it";
  EXPECT_EQ(surface_along(site.map, {4.01, 4.11}, {6.02, 4.11}).places, 0) << "two cells beside it";
}

TEST(SurfaceAlong, OfALineShorterThanACellIsOnePlace) {
  DrawnSite site;
  EXPECT_EQ(surface_along(site.map, {4.01, 4.01}, {4.02, 4.01}).all, 1);
}

}  // namespace
}  // namespace deltamap::mapping::things
