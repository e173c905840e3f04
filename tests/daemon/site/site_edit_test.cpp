// SPDX-License-Identifier: Apache-2.0
#include "daemon/site/site_edit.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

#include "daemon/site/site.hpp"
#include "daemon/site/zones_file.hpp"

namespace deltamap::daemon {
namespace {

const GridGeometry kMap{400, 300, 0.05, {0.0, 0.0}};  // 20 m by 15 m

class SiteEditTest : public testing::Test {
 protected:
  [[nodiscard]] Site after(PlaceKind kind, const std::string& of, const std::string& place) const {
    return edited(site, {kind, version_of(site, kind), of, place}, kMap, "list.yaml");
  }
  [[nodiscard]] std::string complaint(PlaceKind kind, const std::string& of, const std::string& place) const {
    try {
      (void)after(kind, of, place);
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "";
  }

  Site site{
      {{.id = "B4", .name = "Row B", .polygon = {{1, 1}, {3, 1}, {3, 3}, {1, 3}}}},
      {{.id = "walls", .kind = ZoneKind::kFrozen, .polygon = {{0, 14}, {20, 14}, {20, 15}}},
       {.id = "gate", .kind = ZoneKind::kSpeedLimit, .most_speed_m_per_s = 0.3, .polygon = {{4, 4}, {6, 4}, {6, 6}}}}};
};

TEST_F(SiteEditTest, AddsReplacesAndTakesAwayOneAndLeavesTheOthers) {
  const std::string lane =
      R"({"zoneId": "lane", "zoneType": "TEMPORARY", "vertices": [[7, 7], [9, 7.00049], {"x": 9, "y": 9}]})";
  const Site drawn = after(PlaceKind::kZone, "", lane);
  ASSERT_EQ(drawn.zones.size(), 3u);
  EXPECT_EQ(drawn.zones[2].kind, ZoneKind::kTemporary);
  EXPECT_EQ(drawn.zones[2].polygon[1], Point2(9.0, 7.0)) << "to a millimetre, as its file is read again";
  EXPECT_EQ(drawn.bays, site.bays);
  const Site renamed = after(PlaceKind::kZone, "walls", lane);
  EXPECT_EQ(renamed.zones[0].id, "lane") << "in its place of the list";
  EXPECT_EQ(renamed.zones[1], site.zones[1]);
  EXPECT_EQ(after(PlaceKind::kZone, "walls", "").zones, Zones{site.zones[1]});
  EXPECT_TRUE(after(PlaceKind::kBay, "B4", "").bays.empty());
}

TEST_F(SiteEditTest, WhatCannotBeIsRefusedInTheWordsOfAFileWithoutALine) {
  const auto bay = [](const std::string& id, const std::string& corners) {
    return "{\"id\": \"" + id + "\", \"polygon\": [" + corners + "]}";
  };
  EXPECT_EQ(complaint(PlaceKind::kBay, "", bay("B4", "[5, 5], [7, 5], [7, 7]")),
            "list.yaml: bay 'B4' stands twice: each needs an id of its own");
  EXPECT_EQ(complaint(PlaceKind::kBay, "", bay("B5", "[5, 5], [7, 7], [7, 5], [5, 7]")),
            "list.yaml: bay 'B5' crosses itself: its side from corner 1 meets that from corner 3: give the corners in "
            "their order");
  EXPECT_NE(complaint(PlaceKind::kBay, "", bay("B5", "[5, 5], [99, 5], [7, 7]")).find("bay 'B5' lies off the map"),
            std::string::npos);
  EXPECT_NE(complaint(PlaceKind::kBay, "", bay("B5", "[2, 1], [4, 1], [4, 3]")).find("overlaps bay 'B4'"),
            std::string::npos);
  EXPECT_NE(complaint(PlaceKind::kBay, "", bay("B5", "[5, 5], [7, 5]")).find("needs at least three corners"),
            std::string::npos);
  EXPECT_NE(complaint(PlaceKind::kZone, "gate",
                      R"({"zoneId": "gate", "zoneType": "SPEED_LIMIT", "vertices": [[4, 4], [6, 4], [6, 6]]})")
                .find("zone 'gate' needs a maximumSpeed"),
            std::string::npos);
  EXPECT_NE(complaint(PlaceKind::kBay, "", R"({"id": "B5", "colour": "red"})").find("nothing is called 'colour' here"),
            std::string::npos);
  EXPECT_EQ(complaint(PlaceKind::kBay, "B9", ""), "there is no bay 'B9'");
  EXPECT_EQ(complaint(PlaceKind::kBay, "", ""), "neither a place nor one to take away");
  EXPECT_EQ(
      complaint(PlaceKind::kBay, "", bay("B5", "[5, 5], [7, 5], [7, 7]") + ", " + bay("B6", "[8, 8], [9, 8], [9, 9]")),
      "one bay at a time");
}

TEST_F(SiteEditTest, AVersionIsThatOfOneListAndOfAllThatStandsInIt) {
  const Site drawn =
      after(PlaceKind::kBay, "B4", R"({"id": "B4", "name": "Row C", "polygon": [[1, 1], [3, 1], [3, 3], [1, 3]]})");
  EXPECT_NE(version_of(drawn, PlaceKind::kBay), version_of(site, PlaceKind::kBay));
  EXPECT_EQ(version_of(drawn, PlaceKind::kZone), version_of(site, PlaceKind::kZone));
  EXPECT_EQ(version_of(after(PlaceKind::kBay, "B4",
                             R"({"id": "B4", "name": "Row B", "polygon": [[1, 1], [3, 1], [3, 3], [1, 3]]})"),
                       PlaceKind::kBay),
            version_of(site, PlaceKind::kBay));
}

TEST_F(SiteEditTest, IsReadFromItsFileAgainAsItIs) {
  const Site drawn = after(
      PlaceKind::kZone, "",
      R"({"zoneId": "a \"b\"\nc: #", "zoneType": "BLOCKED", "zoneDescriptor": "Größe 1", "vertices": [[1, 1], [2, 1], [2, 2]]})");
  EXPECT_EQ(drawn.zones.back().id, "a \"b\"\nc: #");
  EXPECT_EQ(zones_of_text(file_text(drawn, PlaceKind::kZone), "again"), drawn.zones);
}

}  // namespace
}  // namespace deltamap::daemon
