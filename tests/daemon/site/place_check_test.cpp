// SPDX-License-Identifier: Apache-2.0
#include "daemon/site/place_check.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

namespace deltamap::daemon {
namespace {

TEST(PlaceCheck, NamesThePlaceWithItsLineWhereItHasOne) {
  const ListedPlace place{.id = "Z1", .polygon = {}};
  EXPECT_EQ(name_of_place("page", "zone", place), "page: zone 'Z1'");
  EXPECT_THROW(require_sound({place}, "page", "zone"), std::runtime_error) << "no corners";
}

TEST(PlaceCheck, APlaceMayReachTheMapsBorder) {
  const GridGeometry map{100, 100, 0.05, {-1.0, -1.0}};
  const ListedPlace whole{.id = "all", .polygon = {{-1.0, -1.0}, {4.0, -1.0}, {4.0, 4.0}, {-1.0, 4.0}}};
  EXPECT_NO_THROW(require_on_map({whole}, "zones.yaml", "zone", map));
  const ListedPlace beyond{.id = "off", .polygon = {{-1.1, 0.0}, {1.0, 0.0}, {1.0, 1.0}}};
  EXPECT_THROW(require_on_map({beyond}, "zones.yaml", "zone", map), std::runtime_error);
}

TEST(PlaceCheck, CornersAndBordersAreToldToAMillimetre) {
  const GridGeometry map{741, 741, 0.05, {-1.025, -1.025}};  // to 36.025000000000006
  const ListedPlace beyond{.id = "off", .polygon = {{0.1 + 0.2, 0.0}, {36.026, 0.0}, {36.026, 1.0 / 3.0}}};
  try {
    require_on_map({beyond}, "zones.yaml", "zone", map);
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(),
                 "zones.yaml: zone 'off' lies off the map: its corner 36.026, 0; the map reaches from -1.025, -1.025 "
                 "to 36.025, 36.025, in metres");
  }
  const ListedPlace rounded{.id = "on", .polygon = {{-1.0250001, 0.0}, {36.0252, 0.0}, {36.0252, 1.0}}};
  EXPECT_NO_THROW(require_on_map({rounded}, "zones.yaml", "zone", map)) << "else the line would tell one number twice";
}

}  // namespace
}  // namespace deltamap::daemon
