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

}  // namespace
}  // namespace deltamap::daemon
