// SPDX-License-Identifier: Apache-2.0
#include "daemon/site/place_list.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

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

TEST(PlaceList, AnOutlineMayRepeatCorners) {
  const std::string doubled = "[0, 0], [2, 0], [2.0001, 0], [2, 1], [0, 1]";
  const std::string yaml = "zones: [{zoneId: A, vertices: [" + doubled + ", [0.0, 0.0]]}]";
  const auto places = places_in(yaml, "zones.yaml", kKeys);
  ASSERT_EQ(places.size(), 1u);
  EXPECT_EQ(places[0].polygon, (Polygon{{0.0, 0.0}, {2.0, 0.0}, {2.0, 1.0}, {0.0, 1.0}}));
  EXPECT_EQ(without_repeated_corners({{0.0, 0.0}, {1.0, 0.0}, {0.0, 0.0}}).size(), 2u);
  EXPECT_TRUE(without_repeated_corners({}).empty());
}

TEST(PlaceList, AQuoteThatIsNotClosedSwallowsNoOtherPlace) {
  const std::string yaml =
      "zones:\n"
      "  - {zoneId: a, vertices: [[0, 0], [1, 0], [1, 1]], zoneDescriptor: \"a wall}\n"
      "  - {zoneId: b, vertices: [[2, 0], [3, 0], [3, 1]], zoneType: BLOCKED}\n";
  try {
    (void)places_in(yaml, "zones.yaml", kKeys);
    FAIL() << "was taken";
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(), "zones.yaml: line 2: not YAML: a quote is not closed on its line");
  }
}

TEST(PlaceList, EveryCharacterOfAnIdIsWrittenAsItIs) {
  // Control characters, blanks that are none, characters that are none (U+FFFF, U+FDD0, U+10FFFE), and beyond 16 bits.
  for (const std::string id : {"a\tb\r\n\x7F\xC2\x85", "\xC2\xA0\xE2\x80\xA8\xEF\xBB\xBF", "\xEF\xBF\xBF",
                               "\xEF\xB7\x90\xF4\x8F\xBF\xBE", "\\ \" ' \xF0\x9F\x93\xA6 T\xC3\xBCr", "\xEF\xBF\xBD"}) {
    const std::string yaml = places_as_yaml({{.id = id, .polygon = {{0.0, 0.0}, {1.0, 0.0}, {1.0, 1.0}}}}, kKeys);
    const auto back = places_in(yaml, "zones.yaml", kKeys);
    ASSERT_EQ(back.size(), 1u) << yaml;
    EXPECT_EQ(back[0].id, id) << yaml;
  }
  EXPECT_NE(places_as_yaml({{.id = "T\xC3\xBCr", .polygon = {{0.0, 0.0}}}}, kKeys).find("\"T\xC3\xBCr\""),
            std::string::npos);
}

}  // namespace
}  // namespace deltamap::daemon
