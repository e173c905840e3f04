// SPDX-License-Identifier: Apache-2.0
#include "tool/bays/bay_import.hpp"

#include <gtest/gtest.h>

#include <numbers>
#include <stdexcept>

#include "core/geometry/angle.hpp"

namespace deltamap::tool {
namespace {

const std::string kLif = R"({"metaInformation": {"lifVersion": "1.0.0", "creator": "x"}, "layouts": [{"layoutId": "L",
  "nodes": [], "stations": [
    {"stationId": "ST-1", "interactionNodeIds": ["n1"], "stationName": "Row B, bay 4",
     "stationPosition": {"x": 9.2, "y": 9.2, "theta": 1.5707963}},
    {"stationId": "ST-2", "interactionNodeIds": []}]}]})";
const std::optional<BaySize> kSize = BaySize{2.4, 1.2};

std::string lif_complaint(const std::string& text, const std::optional<BaySize>& size = kSize) {
  try {
    (void)bays_of_lif(text, "site.lif", size);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

std::string csv_complaint(const std::string& text, const std::optional<BaySize>& size = kSize) {
  try {
    (void)bays_of_csv(text, "bays.csv", size);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

TEST(BayImport, AStationOfLifBecomesABayAroundItsPosition) {
  const ImportedBays bays = bays_of_lif(kLif, "site.lif", kSize);
  ASSERT_EQ(bays.bays.size(), 1u);
  EXPECT_EQ(bays.bays[0].id, "ST-1");
  EXPECT_EQ(bays.bays[0].station_id, "ST-1");
  EXPECT_EQ(bays.bays[0].name, "Row B, bay 4");
  const PolygonBox box = bounding_box(bays.bays[0].polygon);
  EXPECT_LT((box.low - Point2{8.6, 8.0}).norm(), 1e-6) << "along theta, which is north";
  EXPECT_LT((box.high - Point2{9.8, 10.4}).norm(), 1e-6);
}

TEST(BayImport, AStationWithoutAPositionIsLeftOutAndTold) {
  const ImportedBays bays = bays_of_lif(kLif, "site.lif", kSize);
  ASSERT_EQ(bays.left_out.size(), 1u);
  EXPECT_EQ(bays.left_out[0],
            "site.lif: /layouts/0/stations/1: station 'ST-2' has no stationPosition: left out, draw its bay by hand");
}

TEST(BayImport, SaysInOneLineWhatIsWrongWithALif) {
  EXPECT_EQ(lif_complaint(kLif, std::nullopt),
            "site.lif: /layouts/0/stations/0: LIF has no size of stations: give --size ALONGxACROSS in metres");
  std::string later = kLif;
  later.replace(later.find("1.0.0"), 5, "2.0.0");
  EXPECT_EQ(lif_complaint(later),
            "site.lif: /metaInformation/lifVersion: is '2.0.0': only LIF 1 is known, export it as 1.0.0");
  EXPECT_EQ(lif_complaint("{\n\"a\": }"), "site.lif: line 2: no JSON");
  EXPECT_EQ(lif_complaint("[1e999]"), "site.lif: holds a number that is too large to be read");
  EXPECT_EQ(lif_complaint("{}"), "site.lif: /metaInformation/lifVersion: is missing: this is no LIF file");
  EXPECT_EQ(lif_complaint(R"({"metaInformation": {"lifVersion": "1.0.0"}, "layouts": []})"),
            "site.lif: /layouts: holds no stations");
  EXPECT_EQ(lif_complaint(R"({"metaInformation": {"lifVersion": "1.0.0"}, "layouts": [{"stations": [{"stationId": "A",
             "stationPosition": {"x": "1", "y": 2}}]}]})"),
            "site.lif: /layouts/0/stations/0/stationPosition: needs the numbers x and y");
  std::string turned = kLif;
  turned.replace(turned.find("1.5707963"), 9, "\"north\"");
  EXPECT_EQ(lif_complaint(turned), "site.lif: /layouts/0/stations/0/stationPosition/theta: must be a number");
  EXPECT_EQ(lif_complaint(R"({"metaInformation": {"lifVersion": "1.0.0"}, "layouts": [{"stations": [{"stationId": "A",
             "stationPosition": [1, 2]}]}]})"),
            "site.lif: /layouts/0/stations/0/stationPosition: needs the numbers x and y");
}

/// A layout with one station.
std::string layout_of(const std::string& id, const std::string& level, const std::string& station) {
  return R"({"layoutId": ")" + id + R"(", "layoutLevelId": ")" + level + R"(", "stations": [{"stationId": ")" +
         station + R"(", "stationPosition": {"x": 1, "y": 2}}]})";
}

std::string lif_of(const std::string& layouts) {
  return R"({"metaInformation": {"lifVersion": "1.0.0"}, "layouts": [)" + layouts + "]}";
}

TEST(BayImport, LayoutsOfOneFloorAreReadTogether) {
  const std::string lif = lif_of(layout_of("L1", "0", "A") + "," + layout_of("L2", "0", "B"));
  EXPECT_EQ(bays_of_lif(lif, "site.lif", kSize).bays.size(), 2u);
}

TEST(BayImport, StationsOfAnotherFloorAreNeverReadAsOnes) {
  const std::string lif =
      lif_of(layout_of("L1", "0", "A") + "," + layout_of("L2", "1", "B") + R"(, {"layoutId": "empty"})");
  EXPECT_EQ(lif_complaint(lif),
            "site.lif: /layouts: are of several levels, and a map is one: give --layout ID of 'L1' of level '0', 'L2' "
            "of level '1'");
  const std::string numbered = lif_of(
      R"({"layoutId": 1, "layoutLevelId": 0, "stations": [{"stationId": "A"}]},
         {"layoutId": 2, "layoutLevelId": 1, "stations": [{"stationId": "B"}]})");
  EXPECT_EQ(lif_complaint(numbered),
            "site.lif: /layouts: are of several levels, and a map is one: give --layout ID of '1' of level '0', '2' of "
            "level '1'");
  const std::string same = lif_of(layout_of("L", "0", "A") + "," + layout_of("L", "1", "B"));
  EXPECT_THROW((void)bays_of_lif(same, "site.lif", kSize, {"L"}), std::runtime_error);
  const ImportedBays upper = bays_of_lif(lif, "site.lif", kSize, {"L2"});
  ASSERT_EQ(upper.bays.size(), 1u);
  EXPECT_EQ(upper.bays[0].id, "B");
  try {
    (void)bays_of_lif(lif, "site.lif", kSize, {"empty"});
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(),
                 "site.lif: /layouts: has no 'empty' with stations: 'L1' of level '0', 'L2' of level '1'");
  }
}

TEST(BayImport, ATableGivesMiddlesOrPolygons) {
  const ImportedBays bays = bays_of_csv(
      "id;name;x_m;y_m;heading_deg;along_m;across_m;polygon_m\r\n"
      "A;\"Row \"\"A\"\"\";2;3;90;2.4;1.2;\r\n"
      "\r\n"
      "B;;;;;;;\"0 0; 2 0; 2 1.5\"\r\n",
      "bays.csv", std::nullopt);
  ASSERT_EQ(bays.bays.size(), 2u);
  EXPECT_EQ(bays.bays[0].name, "Row \"A\"");
  EXPECT_LT((bounding_box(bays.bays[0].polygon).low - Point2{1.4, 1.8}).norm(), 1e-9);
  EXPECT_EQ(bays.bays[1].polygon, (Polygon{{0.0, 0.0}, {2.0, 0.0}, {2.0, 1.5}}));
}

TEST(BayImport, AnOutlineMayBeClosedByItsFirstCorner) {
  EXPECT_EQ(csv_complaint("id,polygon_m\nA,0 0; 2 0; 0 0\n"),
            "bays.csv: line 2: 'polygon_m' needs at least three corners");
  const ImportedBays bays = bays_of_csv("id,polygon_m\nA,0 0; 2 0; 2 1.5; 0 0\n", "bays.csv", std::nullopt);
  EXPECT_EQ(bays.bays.at(0).polygon, (Polygon{{0.0, 0.0}, {2.0, 0.0}, {2.0, 1.5}}));
}

TEST(BayImport, ACellInQuotesMayHoldLineBreaks) {
  const std::string table = "id;name;x_m;y_m\r\nA;\"Row \"\"A\"\"\r\nbay 1\";2;3\r\nB;;4;x\r\n";
  EXPECT_EQ(csv_complaint(table), "bays.csv: line 4: 'y_m' must be a number with a point, not 'x'");
  const ImportedBays bays = bays_of_csv(table.substr(0, table.find("B;")), "bays.csv", kSize);
  ASSERT_EQ(bays.bays.size(), 1u);
  EXPECT_EQ(bays.bays[0].name, "Row \"A\" bay 1");
  EXPECT_EQ(csv_complaint("id,name,x_m,y_m\nA,\"open,1,2\nB,,1,2\n"),
            "bays.csv: line 2: has a quote that is not closed");
  EXPECT_EQ(csv_complaint("id;x_m;y_m;name\nA;2;3;\"Row A\nB;9;3;Row B\n"),
            "bays.csv: line 2: has a quote that is not closed");
  const ImportedBays inches =
      bays_of_csv("id;x_m;y_m;name\nA;2;3;Shelf 19\" left\nB;9;3;Shelf 19\" right\n", "bays.csv", kSize);
  ASSERT_EQ(inches.bays.size(), 2u);
  EXPECT_EQ(inches.bays[0].name, "Shelf 19\" left");
}

TEST(BayImport, SaysInOneLineWhatIsWrongWithATable) {
  EXPECT_EQ(csv_complaint("id,x_m,y_m\nA,1\n"), "bays.csv: line 2: has 2 cells, the first line 3");
  EXPECT_EQ(csv_complaint("id,x_m,y_m\nA,1,zwei\n"),
            "bays.csv: line 2: 'y_m' must be a number with a point, not 'zwei'");
  EXPECT_EQ(csv_complaint("id,x_m,y_m\n,1,2\n"), "bays.csv: line 2: 'id' is empty");
  EXPECT_EQ(csv_complaint("id,x_m,y_m\nA,1,2\nTor S\xFC"
                          "d,1,2\n"),
            "bays.csv: line 3: a character that is not UTF-8: write the file in UTF-8");
  EXPECT_EQ(csv_complaint("id,x_m,y_m\nA,1,2\n", std::nullopt),
            "bays.csv: line 2: bay 'A' has no size: give along_m and across_m, or --size ALONGxACROSS in metres");
  EXPECT_EQ(csv_complaint("id,x\nA,1\n"),
            "bays.csv: line 1: nothing is called 'x' here: id, name, stationId, x_m, y_m, heading_deg, along_m, "
            "across_m, polygon_m");
  EXPECT_EQ(csv_complaint("id,polygon_m\nA,1 2\n"), "bays.csv: line 2: 'polygon_m' needs at least three corners");
  EXPECT_EQ(csv_complaint(""), "bays.csv: is empty");
  EXPECT_EQ(csv_complaint("id,x_m,y_m,x_m\nA,1,2,3\n"), "bays.csv: line 1: 'x_m' stands twice");
  EXPECT_EQ(csv_complaint("id,x_m,y_m,along_m\nA,1,2,3\n"),
            "bays.csv: line 2: bay 'A' has one of along_m and across_m: give both or none");
}

TEST(BayImport, ATableThatIsNoTextIsToldAsThat) {
  using namespace std::string_literals;
  EXPECT_EQ(csv_complaint("id,x_m,y_m\nA,1,\0\n"s), "bays.csv: line 2: no text file: it has the byte 00h");
}

TEST(BayImport, ASizeIsTwoLengths) {
  EXPECT_DOUBLE_EQ(bay_size_in("2.4x1.2").along_m, 2.4);
  for (const char* wrong : {"2.4", "x1", "2x-1", "2x1x3", "axb", "nanx1"})
    EXPECT_THROW((void)bay_size_in(wrong), std::runtime_error) << wrong;
}

}  // namespace
}  // namespace deltamap::tool
