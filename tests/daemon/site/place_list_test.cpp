// SPDX-License-Identifier: Apache-2.0
#include "daemon/site/place_list.hpp"

#include <gtest/gtest.h>

namespace deltamap::daemon {
namespace {

const PlaceKeys kKeys{"zones", "zoneId", "vertices", {"zoneType", "zoneDescriptor"}};

TEST(PlaceList, WhatIsWrittenReadsBackWhateverItsWords) {
  const std::vector<ListedPlace> places{
      {.id = "a: \"b\"", .polygon = {{0.0, 0.0}, {1.2345, 0.0}, {1.0, -2.5}}, .words = {{"zoneType", "# no\nnews"}}}};
  const auto back = places_in(places_as_yaml(places, kKeys), "zones.yaml", kKeys);
  ASSERT_EQ(back.size(), 1u);
  EXPECT_EQ(back[0].id, places[0].id);
  EXPECT_EQ(back[0].words, places[0].words);
  EXPECT_EQ(back[0].polygon[2], places[0].polygon[2]);
  EXPECT_NEAR(back[0].polygon[1].x(), 1.2345, 0.0006);
}

}  // namespace
}  // namespace deltamap::daemon
