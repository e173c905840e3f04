// SPDX-License-Identifier: Apache-2.0
#include "core/files/grid_file.hpp"

#include <gtest/gtest.h>

#include "core/files/replace_file.hpp"
#include "core/random.hpp"
#include "tests/support/files/not_root.hpp"
#include "tests/support/files/temporary_folder.hpp"
#include "tests/support/worlds/drawn_grid.hpp"

namespace deltamap {
namespace {

const std::string kKeys =
    "resolution: 0.1\norigin: [-1.5, 2, 0]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n";

std::string refusal(const std::filesystem::path& file) {
  try {
    (void)read_grid(file);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

TEST(GridFile, ReadsWhatItWrote) {
  const test::TemporaryFolder folder;
  const OccupancyGrid grid = test::drawn_grid({"#. ", " .#"}, 0.05, {-17.0, -14.0});
  write_grid(grid, folder.path() / "map.yaml");
  EXPECT_EQ(read_grid(folder.path() / "map.yaml"), grid);
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "map.yaml.part"));
}

TEST(GridFile, ReadsAndWritesMapsOfManyTilesMostOfThemUnknown) {
  const test::TemporaryFolder folder;
  Random random{2};
  OccupancyGrid grid{{777, 333, 0.05, {0.0, 0.0}}};
  for (int i = 0; i < 2000; ++i) {
    grid.set({static_cast<int>(200 + random.index_below(150)), static_cast<int>(random.index_below(333))},
             static_cast<CellState>(random.index_below(3)));
  }
  write_grid(grid, folder.path() / "map.yaml");
  const OccupancyGrid read = read_grid(folder.path() / "map.yaml");
  EXPECT_EQ(read, grid);
  EXPECT_LE(read.tiles().tiles_written(), grid.tiles().tiles_written());
  EXPECT_EQ(std::filesystem::file_size(folder.path() / "map.pgm"),
            std::string{"P5\n777 333\n255\n"}.size() + 777U * 333U);
}

TEST(GridFile, NamesAMapOfCarmen) {
  const test::TemporaryFolder folder;
  const std::string told = ": is a CARMEN map; give a map_server map (YAML and PGM)";
  EXPECT_NE(refusal(folder.write("site.map", "\x1F\x8B\x08")).find("site.map" + told), std::string::npos);
  EXPECT_NE(refusal(folder.write("unpacked", "####\nCARMENMAPFILEv020")).find("unpacked" + told), std::string::npos);
}

TEST(GridFile, NamesThePictureThatWasGivenForItsDescription) {
  const test::TemporaryFolder folder;
  const auto picture = folder.write("site.pgm", "P5\n2 1\n255\n\x01\x02");
  const std::string told = picture.string() + ": is the picture of a map; give its description (YAML)";
  EXPECT_EQ(refusal(picture), told);
  const auto description = folder.write("site.yaml", "image: site.pgm\n");
  EXPECT_EQ(refusal(picture), told + ", " + description.string());
}

TEST(GridFile, NamesAFileThatIsNoText) {
  const test::TemporaryFolder folder;
  const auto file = folder.write("site.yaml", std::string("image: a\n\0", 10));
  EXPECT_EQ(refusal(file), file.string() + ": byte 9: is no text; give a map's description (YAML)");
}

TEST(GridFile, TellsWhatTheSystemForbids) {
  const test::TemporaryFolder folder;
  std::filesystem::create_directory(folder.path() / "inside");
  const auto file = folder.write("inside/site.yaml", "image: site.pgm\n");
  std::filesystem::permissions(folder.path() / "inside", std::filesystem::perms::none);
  const test::NotRoot another_user;
  EXPECT_EQ(refusal(file), file.string() + ": Permission denied");
}

TEST(GridFile, WritesNumbersAsPeopleDoAndReadsThemBackExactly) {
  const test::TemporaryFolder folder;
  const auto file = folder.path() / "map.yaml";
  write_grid(test::drawn_grid({"#"}, 0.05, {-12.3, 7.0}), file);
  std::ifstream written(file);
  EXPECT_EQ((std::string{std::istreambuf_iterator<char>(written), {}}),
            "image: map.pgm\nresolution: 0.05\norigin: [-12.3, 7, 0.0]\nnegate: 0\noccupied_thresh: 0.65\n"
            "free_thresh: 0.196\n");
  const OccupancyGrid awkward = test::drawn_grid({"#"}, 1.0 / 3.0, {-12.3 - 3 * 0.05, 1e-17});
  write_grid(awkward, file);
  EXPECT_EQ(read_grid(file), awkward);
}

TEST(GridFile, WritesSmallNumbersSoThatReadersOfYaml11KnowThemAsNumbers) {
  const test::TemporaryFolder folder;
  const auto file = folder.path() / "map.yaml";
  write_grid(test::drawn_grid({"#"}, 0.05, {1e-05, -2.5e-07}), file);
  std::ifstream written(file);
  const std::string text{std::istreambuf_iterator<char>(written), {}};
  EXPECT_NE(text.find("origin: [1.0e-05, -2.5e-07, 0.0]"), std::string::npos) << text;
}

TEST(GridFile, ReadsForeignShadesAndComments) {
  const test::TemporaryFolder folder;
  folder.write("m.pgm", std::string("P5\n# by another hand\n3 1\n# again\n100\n") + "\x00" + "\x64" + "\x32");
  const std::string pixels{'\x00', '\x64', '\x32'};
  folder.write("m.pgm", "P5\n# by another hand\n3 1\n100\n" + pixels);
  const OccupancyGrid grid = read_grid(folder.write("m.yaml", "image: m.pgm\n" + kKeys));
  EXPECT_EQ((grid[Cell{0, 0}]), CellState::kOccupied);
  EXPECT_EQ((grid[Cell{1, 0}]), CellState::kFree);
  EXPECT_EQ((grid[Cell{2, 0}]), CellState::kUnknown);
  EXPECT_EQ(grid.geometry().origin, Point2(-1.5, 2.0));
}

TEST(GridFile, NamesFileAndPlaceOfWhatItCannotRead) {
  const test::TemporaryFolder folder;
  EXPECT_NE(refusal(folder.path() / "none.yaml").find("none.yaml: No such file"), std::string::npos);
  EXPECT_NE(refusal(folder.write("empty.yaml", "")).find("empty.yaml: line 1"), std::string::npos);
  EXPECT_NE(refusal(folder.write("noise.yaml", "\x01{[")).find("noise.yaml: byte 0: is no text"), std::string::npos);
  EXPECT_NE(refusal(folder.write("turned.yaml", "image: m.pgm\nresolution: 0.1\norigin: [0, 0, 0.5]\n"))
                .find("turned.yaml: line 1: picture "),
            std::string::npos)
      << "the origin of a turned picture depends on its size";
  for (const char* resolution : {"0.0000001", "1e6", "nan", "-0.05"}) {
    const std::string keys = std::string("image: m.pgm\nresolution: ") + resolution + "\norigin: [0, 0, 0]\n";
    EXPECT_NE(refusal(folder.write("wild.yaml", keys)).find("'resolution'"), std::string::npos) << resolution;
  }
  folder.write("cut.pgm", "P5 100 100 255\nabc");
  EXPECT_NE(refusal(folder.write("cut.yaml", "image: cut.pgm\n" + kKeys)).find("cut.pgm: byte 18: cut short"),
            std::string::npos);
}

TEST(GridFile, NamesLineAndKeyOfAWrongDescription) {
  const test::TemporaryFolder folder;
  const auto told = [&](const std::string& text) {
    const auto file = folder.write("m.yaml", text);
    const std::string why = refusal(file);
    EXPECT_EQ(why.find(file.string() + ": "), 0u) << why;
    return why.substr(std::min(why.size(), file.string().size() + 2));
  };
  const std::string image = "image: m.pgm\n";
  EXPECT_EQ(told(image + "resolution: 0.1\n"), "key 'origin' is missing");
  EXPECT_EQ(told(image + "resolution: 0.1\norigin: 3\n"), "line 3: 'origin' must be [x, y, yaw]");
  EXPECT_EQ(told(image + image + kKeys), "line 2: 'image' is given twice");
  EXPECT_EQ(told("image: \"m.pgm\nresolution: 0.1\n"), "line 1: not YAML: a quote is not closed on its line");
  EXPECT_EQ(told(image + "origin: [0, 0, 0\n"), "line 2: not YAML: a '[' is not closed");
  EXPECT_EQ(told(image + kKeys + "...\nnegate: 1\n"),
            "line 8: not YAML: this belongs to no key: look at the indentation of this line and of those above");
  EXPECT_EQ(told("image: m.pgm\nresolution: 0.1\norigin: [0, 0, 0]\noccupied_thresh: 65\n"),
            "line 4: 'occupied_thresh' must be 0 to 1, not 65 (percent?)");
  EXPECT_EQ(told("image: m.pgm\nresolution: 0.1\norigin: [0, 0, 0]\nfree_thresh: -1\n"),
            "line 4: 'free_thresh' must be 0 to 1, not -1");
}

TEST(GridFile, LeavesNothingBehindWhereItCannotWrite) {
  const test::TemporaryFolder folder;
  EXPECT_THROW(replace_file(folder.path() / "missing" / "file", "x"), std::runtime_error);
  std::filesystem::create_directory(folder.path() / "taken");
  EXPECT_THROW(replace_file(folder.path() / "taken", "x"), std::runtime_error);
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "taken.part"));
}

}  // namespace
}  // namespace deltamap
