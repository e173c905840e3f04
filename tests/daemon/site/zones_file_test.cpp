// SPDX-License-Identifier: Apache-2.0
#include "daemon/site/zones_file.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <stdexcept>

#include "daemon/site/site.hpp"
#include "tests/support/files/temporary_folder.hpp"

namespace deltamap::daemon {
namespace {

const std::string kZones =
    "zones:\n"
    "  - zoneId: walls\n"
    "    zoneType: FROZEN\n"
    "    zoneDescriptor: the north wall\n"
    "    vertices: [{x: 0, y: 14}, {x: 20, y: 14}, {x: 20, y: 15}, {x: 0, y: 15}]\n"
    "  - zoneId: gate\n"
    "    zoneType: SPEED_LIMIT\n"
    "    maximumSpeed: 0.3\n"
    "    vertices: [[4, 4], [6, 4], [6, 6]]\n";

class ZonesFile : public testing::Test {
 protected:
  [[nodiscard]] Zones read(const std::string& yaml) const {
    std::ofstream{file} << yaml;
    return zones_on(map, file);
  }
  [[nodiscard]] std::string complaint(const std::string& yaml) const {
    try {
      (void)read(yaml);
    } catch (const std::runtime_error& error) {
      return std::string(error.what()).substr(file.size() + 2);
    }
    return "";
  }
  [[nodiscard]] static std::string with(const std::string& words) {
    return "zones:\n  - zoneId: Z\n    vertices: [[1, 1], [3, 1], [3, 3]]\n    " + words + "\n";
  }

  test::TemporaryFolder folder;
  std::string file = folder.path() / "zones.yaml";
  GridGeometry map{400, 300, 0.05, {0.0, 0.0}};
};

TEST_F(ZonesFile, IsReadAsWrittenAndSurvivesARecording) {
  const Zones zones = read(kZones);
  ASSERT_EQ(zones.size(), 2u);
  EXPECT_EQ(zones[0].kind, ZoneKind::kFrozen);
  EXPECT_EQ(zones[0].description, "the north wall");
  EXPECT_EQ(zones[0].polygon[1], (Point2{20.0, 14.0}));
  EXPECT_EQ(zones[1].kind, ZoneKind::kSpeedLimit);
  EXPECT_DOUBLE_EQ(zones[1].most_speed_m_per_s, 0.3);
  EXPECT_EQ(zones_of_text(zones_as_yaml(zones), "again"), zones);
  EXPECT_NE(zones_as_yaml(zones).find("    maximumSpeed: 0.3\n"), std::string::npos) << "a number, as VDA 5050 has it";
  const Site site{{{.id = "B4", .polygon = zones[1].polygon}}, zones};
  ASSERT_TRUE(site_of_text(text_of(site)));
  EXPECT_EQ(*site_of_text(text_of(site)), site);
  EXPECT_EQ(site_of_text("nonsense"), nullptr);
}

TEST_F(ZonesFile, SaysInOneLineWhatCannotBe) {
  EXPECT_EQ(complaint(with("zoneType: WALL")),
            "line 2: zone 'Z' has the unknown zoneType 'WALL': FROZEN, TEMPORARY, IGNORE, BLOCKED or SPEED_LIMIT");
  EXPECT_EQ(complaint(with("zoneDescriptor: x")),
            "line 2: zone 'Z' has no zoneType: FROZEN, TEMPORARY, IGNORE, BLOCKED or SPEED_LIMIT");
  EXPECT_EQ(complaint(with("zoneType: SPEED_LIMIT")),
            "line 2: zone 'Z' needs a maximumSpeed from 0.05 to 10 m/s; where nobody may drive it is BLOCKED");
  EXPECT_TRUE(complaint(with("zoneType: SPEED_LIMIT\n    maximumSpeed: 0.015")).find("from 0.05 to 10 m/s") !=
              std::string::npos);
  EXPECT_EQ(complaint(with("zoneType: FROZEN\n    zoneDescriptor: T\xFCr")),
            "line 5: a character that is not UTF-8: write the file in UTF-8");
  EXPECT_EQ(complaint(with("zoneType: FROZEN\n    maximumSpeed: 1")),
            "line 2: zone 'Z' has a maximumSpeed, which only SPEED_LIMIT has");
  EXPECT_EQ(complaint(kZones + "  - {zoneId: gate, zoneType: IGNORE, vertices: [[1, 1], [3, 1], [3, 3]]}\n"),
            "line 10: zone 'gate' stands twice: first in line 6: each needs an id of its own");
  EXPECT_EQ(complaint("zones:\n  - {zoneId: X, zoneType: IGNORE, vertices: [[1, 1], [3, 3], [3, 1], [1, 3]]}\n"),
            "line 2: zone 'X' crosses itself: its side from corner 1 meets that from corner 3: give the corners in "
            "their order");
  EXPECT_EQ(complaint("zones:\n  - {zoneId: X, zoneType: IGNORE, vertices: [[1, 1], [33, 3], [3, 3]]}\n"),
            "line 2: zone 'X' lies off the map: its corner 33, 3; the map reaches from 0, 0 to 20, 15, in metres");
}

}  // namespace
}  // namespace deltamap::daemon
