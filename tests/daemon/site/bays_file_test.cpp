// SPDX-License-Identifier: Apache-2.0
#include "daemon/site/bays_file.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <stdexcept>

#include "tests/support/files/temporary_folder.hpp"

namespace deltamap::daemon {
namespace {

const std::string kTwoBays =
    "bays:\n"
    "  - id: B4\n"
    "    name: 'Row B, bay 4'\n"
    "    stationId: ST-17\n"
    "    polygon: [[8.0, 8.0], [10.4, 8.0], [10.4, 10.4], [8.0, 10.4]]\n"
    "  - id: 5\n"
    "    polygon: [{x: 10.4, y: 8.0}, {x: 12.8, y: 8.0}, {x: 12.8, y: 10.4}, {x: 10.4, y: 10.4}]\n";

class BaysFile : public testing::Test {
 protected:
  [[nodiscard]] std::string written(const std::string& yaml) const {
    std::ofstream{file} << yaml;
    return file;
  }
  /// What is wrong with it, without the file's name.
  [[nodiscard]] std::string complaint(const std::string& yaml) const {
    try {
      (void)bays_on(map, written(yaml));
    } catch (const std::runtime_error& error) {
      const std::string line = error.what();
      EXPECT_TRUE(line.starts_with(file + ": ")) << line;
      EXPECT_EQ(line.find('\n'), std::string::npos);
      return line.substr(std::min(line.size(), file.size() + 2));
    }
    return "";
  }
  [[nodiscard]] static std::string with_polygon(const std::string& corners) {
    return "bays:\n  - id: A\n    polygon: " + corners + "\n";
  }

  test::TemporaryFolder folder;
  std::string file = (folder.path() / "bays.yaml").string();
  GridGeometry map{400, 300, 0.05, {0.0, 0.0}};
};

TEST_F(BaysFile, IsReadAsWritten) {
  const auto bays = bays_on(map, written(kTwoBays));
  ASSERT_EQ(bays.size(), 2u);
  EXPECT_EQ(bays[0].id, "B4");
  EXPECT_EQ(bays[0].name, "Row B, bay 4");
  EXPECT_EQ(bays[0].station_id, "ST-17");
  EXPECT_EQ(bays[1].id, "5");
  EXPECT_EQ(bays[1].polygon[2], (Point2{12.8, 10.4}));
  EXPECT_EQ(read_bays(written(bays_as_yaml(bays))), bays) << "and written again";
}

TEST_F(BaysFile, WithoutANameThereAreNone) {
  EXPECT_TRUE(bays_on(map, "").empty());
  EXPECT_TRUE(bays_on(map, written("bays:\n")).empty());
}

TEST_F(BaysFile, SaysInOneLineWhatCannotBe) {
  EXPECT_EQ(complaint(kTwoBays + "  - id: B4\n    polygon: [[1, 1], [3, 1], [3, 3]]\n"),
            "line 8: bay 'B4' stands twice: first in line 2: each needs an id of its own");
  EXPECT_EQ(complaint(with_polygon("[[1, 1], [3, 3], [3, 1], [1, 3]]")),
            "line 2: bay 'A' crosses itself: its side from corner 1 meets that from corner 3: give the corners in "
            "their order");
  EXPECT_EQ(complaint(with_polygon("[[1, 1], [30, 1], [30, 3]]")),
            "line 2: bay 'A' lies off the map: its corner 30, 1; the map reaches from 0, 0 to 20, 15, in metres");
  EXPECT_EQ(complaint(kTwoBays + "  - id: C\n    polygon: [[9, 9], [11, 9], [11, 10], [9, 10]]\n"),
            "line 8: bay 'C' overlaps bay 'B4' by 1.4 m²: what stands there would count twice");
  EXPECT_EQ(complaint(with_polygon("[[1, 1], [1.3, 1], [1.3, 1.3]]")),
            "line 2: bay 'A' is smaller than 0.3 m²: nothing can be told of it, are its corners in metres?");
}

TEST_F(BaysFile, IsReadStrictly) {
  EXPECT_EQ(complaint(with_polygon("[[1, 1], [3, 1]]")), "line 3: 'polygon' needs at least three corners");
  EXPECT_EQ(complaint(with_polygon("[[1, 1], [3, 1], [3, nan]]")),
            "line 3: a corner must be [x, y] or {x: …, y: …}, in metres");
  EXPECT_EQ(complaint("bays:\n  - id: A\n"), "line 2: 'polygon' is missing");
  EXPECT_EQ(complaint("bays:\n  - id: A\n    stationID: 7\n"), "line 3: nothing is called 'stationID' here");
  EXPECT_EQ(complaint("zones: []\n"), "line 1: must hold 'bays:' and a list, and nothing else");
  EXPECT_EQ(complaint("bays: [\n"), "line 1: not YAML: a '[' is not closed");
  EXPECT_EQ(complaint("bays: []\n---\nbays: []\n"),
            "line 2: not YAML: this belongs to no key: look at the indentation of this line and of those above");
  EXPECT_EQ(complaint("bays:\n  - 7\n"), "line 2: an entry of 'bays' must hold keys and values");
}

TEST_F(BaysFile, OfNothingNoLineIsNamed) {
  const std::string nothing = "holds nothing yet: it must hold 'bays:' and a list, and nothing else";
  for (const char* yaml : {"", "\n", "# bays of hall 2\n\n", "---\n", "---\n# none\n...\n"})
    EXPECT_EQ(complaint(yaml), nothing) << yaml;
}

TEST_F(BaysFile, WhatIsNoTextIsToldAsThat) {
  using namespace std::string_literals;
  EXPECT_EQ(complaint("\0bays: []\n"s), "line 1: no text file: it has the byte 00h");
  EXPECT_EQ(complaint("bays:\n  - id: \0\n"s), "line 2: no text file: it has the byte 00h");
  EXPECT_EQ(complaint("\xFF\xFE"
                      "b\0"s),
            "line 1: UTF-16: save it as UTF-8");
}

TEST_F(BaysFile, AFileThatIsMissingIsNamed) {
  std::filesystem::remove(file);
  EXPECT_THROW((void)bays_on(map, file), std::runtime_error);
}

}  // namespace
}  // namespace deltamap::daemon
