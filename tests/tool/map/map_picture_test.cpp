// SPDX-License-Identifier: Apache-2.0
#include "daemon/maps/map_picture.hpp"

#include <gtest/gtest.h>
#include <png.h>

#include <array>
#include <cmath>
#include <vector>

#include "core/files/grid_file.hpp"
#include "daemon/maps/png_bytes.hpp"
#include "mapping/store/map_store.hpp"
#include "tests/support/files/temporary_folder.hpp"
#include "tests/support/files/text_file.hpp"
#include "tests/support/files/tool_run.hpp"
#include "tests/support/worlds/drawn_grid.hpp"
#include "tool/picture/animated_png.hpp"
#include "tool/picture/changed_places.hpp"
#include "tool/picture/ink.hpp"
#include "tool/picture/scene.hpp"

namespace deltamap::tool {
namespace {

using test::content_of;

using picture::drawn;
using picture::Ink;
using picture::Raster;
using picture::Scene;
using test::run_deltamap;

Ink at(const Raster& picture, std::size_t x, std::size_t y) {
  const std::size_t i = (y * picture.width + x) * 3;
  return {picture.rgb.at(i), picture.rgb.at(i + 1), picture.rgb.at(i + 2)};
}

std::size_t pixels_of(const Raster& picture, const Ink& ink) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < picture.rgb.size(); i += 3) {
    count += picture.rgb[i] == ink[0] && picture.rgb[i + 1] == ink[1] && picture.rgb[i + 2] == ink[2] ? 1 : 0;
  }
  return count;
}

/// As every program that knows no animation reads it.
Raster decoded(const std::string& png) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  EXPECT_NE(png_image_begin_read_from_memory(&image, png.data(), png.size()), 0) << image.message;
  image.format = PNG_FORMAT_RGB;
  Raster picture{image.width, image.height, std::vector<std::uint8_t>(PNG_IMAGE_SIZE(image))};
  EXPECT_NE(png_image_finish_read(&image, nullptr, picture.rgb.data(), 0, nullptr), 0) << image.message;
  return picture;
}

OccupancyGrid room() {
  OccupancyGrid map{{100, 80, 0.05, {-1.0, -2.0}}, CellState::kFree};
  for (int column = 0; column < 100; ++column) map.set({column, 0}, CellState::kOccupied);
  return map;
}

// --- /api/map.png ---

TEST(MapPicture, HasAPixelACellAndTheHighestRowOnTop) {
  const Raster picture = decoded(daemon::map_picture(test::drawn_grid({"#.", " #"})));
  ASSERT_EQ(picture.width, 2u);
  ASSERT_EQ(picture.height, 2u);
  EXPECT_LT(at(picture, 0, 0)[0], 50);
  EXPECT_EQ(at(picture, 1, 0), (Ink{255, 255, 255}));
  EXPECT_LT(at(picture, 1, 1)[0], 50);
  EXPECT_EQ(at(picture, 0, 1), picture::kUnknown);
}

// --- for people ---

TEST(Scene, ColoursWhatHasChangedAndPutsTheHighestRowOnTop) {
  const OccupancyGrid before = test::drawn_grid({"#.", "##"});
  const OccupancyGrid after = test::drawn_grid({"##", ". "});
  Scene scene{.map = after, .before = &before};
  scene.shown = after.box();
  scene.cell_pixels = 16;
  const Raster picture = drawn(scene);
  const std::size_t left = (picture.width - 32) / 2;  // in the middle above its legend
  // The corners of the cells: rings lie around them.
  EXPECT_EQ(at(picture, left + 1, 1), picture::kOccupied);
  EXPECT_EQ(pixels_of(drawn({.map = after}), picture::kNewlyOccupied), 0u);
  EXPECT_GT(pixels_of(picture, picture::kNewlyOccupied), 100u);
  EXPECT_GT(pixels_of(picture, picture::kNewlyFree), 100u);
  EXPECT_GT(pixels_of(picture, picture::kForgotten), 100u);
}

TEST(Scene, RingsASmallChangeAndNoLargeOne) {
  const OccupancyGrid before = room();
  OccupancyGrid small = before;
  small.set({50, 40}, CellState::kOccupied);
  OccupancyGrid large = before;
  for (int column = 30; column < 60; ++column) large.set({column, 40}, CellState::kOccupied);
  const std::size_t in_legend = pixels_of(drawn({.map = before, .before = &before}), picture::kRing);
  EXPECT_GT(in_legend, 0u);
  EXPECT_GT(pixels_of(drawn({.map = small, .before = &before}), picture::kRing), in_legend + 20);
  EXPECT_EQ(pixels_of(drawn({.map = large, .before = &before}), picture::kRing), in_legend);
}

TEST(Scene, DrawsRobotPathAndScanWhereTheyAre) {
  const OccupancyGrid map = room();
  Scene scene{.map = map};
  scene.cell_pixels = 4;
  scene.shown = map.box();
  const Raster bare = drawn(scene);
  scene.robot = Pose2{1.0, 0.0, 0.0};
  scene.path = std::vector<Point2>{{0.0, -1.0}, {1.0, -1.0}};
  scene.scan_ends = {{3.0, 1.0}};
  const Raster picture = drawn(scene);
  const auto pixel = [&](const Point2& point) {
    return at(picture, static_cast<std::size_t>((point.x() + 1.0) / 0.05 * 4.0),
              static_cast<std::size_t>((80.0 - (point.y() + 2.0) / 0.05) * 4.0));
  };
  EXPECT_EQ(pixel({0.95, 0.2}), picture::kRobot);
  EXPECT_EQ(pixel({0.5, -1.0}), picture::kPath);
  EXPECT_EQ(pixel({3.0, 1.0}), picture::kScan);
  for (const Ink& ink : {picture::kRobot, picture::kPath, picture::kScan}) EXPECT_EQ(pixels_of(bare, ink), 0u);
}

TEST(Scene, RefusesMapsOfDifferentSizeAndPicturesWithoutEnd) {
  const OccupancyGrid one = test::drawn_grid({"#"});
  const OccupancyGrid other = test::drawn_grid({"##"});
  EXPECT_THROW((void)drawn({.map = one, .before = &other}), std::runtime_error);
  const OccupancyGrid huge{{9000, 9000, 0.05, {0.0, 0.0}}, CellState::kUnknown};
  EXPECT_THROW((void)drawn({.map = huge}), std::runtime_error);
}

TEST(Scene, OfAMapOfWhichNothingIsKnownTheWholeIsDrawn) {
  const OccupancyGrid empty{{10, 10, 0.05, {0.0, 0.0}}, CellState::kUnknown};
  EXPECT_GT(pixels_of(drawn({.map = empty}), picture::kUnknown), 100u);
}

/// As somebody sees it who lacks one kind of cone (Viénot, Brettel and Mollon 1999, linear RGB): 0 red, 1 green, 2 all.
std::array<double, 3> seen_without(int cone, const Ink& ink) {
  std::array<double, 3> linear{};
  for (std::size_t i = 0; i < 3; ++i) linear[i] = std::pow(ink[i] / 255.0, 2.2);
  if (cone == 2) return linear;
  const double red_green =
      cone == 0 ? 0.11238 * linear[0] + 0.88762 * linear[1] : 0.29275 * linear[0] + 0.70725 * linear[1];
  const double blue = (cone == 0 ? 0.00401 * (linear[0] - linear[1]) : -0.02234 * (linear[0] - linear[1])) + linear[2];
  return {red_green, red_green, blue};
}

/// CIE 1976 L*a*b* of linear sRGB.
std::array<double, 3> lab(const std::array<double, 3>& c) {
  const auto f = [](double t) { return t > 0.008856 ? std::cbrt(t) : 7.787 * t + 16.0 / 116.0; };
  const double x = f((0.4124 * c[0] + 0.3576 * c[1] + 0.1805 * c[2]) / 0.9505);
  const double y = f(0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2]);
  const double z = f((0.0193 * c[0] + 0.1192 * c[1] + 0.9505 * c[2]) / 1.089);
  return {116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)};
}

TEST(Inks, AreToldApartByColourBlindPeople) {
  constexpr double kClearlyDifferent = 15.0;  // 2.3 is just noticeable
  const std::array<Ink, 6> cells{picture::kFree,          picture::kOccupied,  picture::kUnknown,
                                 picture::kNewlyOccupied, picture::kNewlyFree, picture::kForgotten};
  for (const int cone : {0, 1, 2}) {
    for (std::size_t i = 0; i < cells.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        const auto a = lab(seen_without(cone, cells[i]));
        const auto b = lab(seen_without(cone, cells[j]));
        EXPECT_GT(std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]), kClearlyDifferent)
            << cone << ": " << i << ", " << j;
      }
    }
  }
}

TEST(ChangedPlaces, JoinsWhatLiesTogether) {
  std::vector<CellChange> changes;
  for (const Cell cell : {Cell{1, 1}, Cell{3, 1}, Cell{5, 2}, Cell{20, 1}, Cell{20, 4}}) changes.push_back({cell});
  EXPECT_EQ(picture::changed_places(changes, 2),
            (std::vector<CellBox>{{{1, 1}, {6, 3}}, {{20, 1}, {21, 2}}, {{20, 4}, {21, 5}}}));
  EXPECT_TRUE(picture::changed_places({}, 2).empty());
}

// --- animated ---

std::uint32_t u32_at(const std::string& bytes, std::size_t at) {
  std::uint32_t number = 0;
  for (std::size_t i = 0; i < 4; ++i) number = number << 8U | static_cast<unsigned char>(bytes.at(at + i));
  return number;
}

/// Names and data of a file's chunks.
std::vector<std::pair<std::string, std::string>> chunks_of(const std::string& png) {
  std::vector<std::pair<std::string, std::string>> chunks;
  for (std::size_t at = 8; at < png.size(); at += 12 + u32_at(png, at)) {
    chunks.emplace_back(png.substr(at + 4, 4), png.substr(at + 8, u32_at(png, at)));
  }
  return chunks;
}

Raster plain(std::size_t width, std::size_t height, std::uint8_t grey) {
  return {width, height, std::vector<std::uint8_t>(3 * width * height, grey)};
}

TEST(AnimatedPng, HasEveryFrameAndShowsItsFirstToOldPrograms) {
  Raster second = plain(20, 10, 200);
  for (std::size_t i = 0; i < 3; ++i) second.rgb[3 * (4 * 20 + 7) + i] = 9;
  const std::string png =
      picture::animated_png({{plain(20, 10, 200), 100}, {second, 250}, {second, 50}, {plain(20, 10, 0), 2000}});
  EXPECT_EQ(decoded(png), plain(20, 10, 200)) << "its checksums hold, and the first frame is the picture";
  std::vector<std::string> names;
  std::uint32_t sequence = 0;
  for (const auto& [name, data] : chunks_of(png)) {
    names.push_back(name);
    if (name == "acTL") {
      EXPECT_EQ(u32_at(data, 0), 4u);
    }
    if (name == "fcTL" || name == "fdAT") {
      EXPECT_EQ(u32_at(data, 0), sequence++);
    }
    if (name == "fcTL" && sequence == 2) {
      EXPECT_EQ(u32_at(data, 4), 1u) << "what differs is a pixel";
      EXPECT_EQ(u32_at(data, 12), 7u);
      EXPECT_EQ(u32_at(data, 16), 4u);
      EXPECT_EQ(static_cast<int>(data[21]), static_cast<char>(250)) << "ms";
    }
  }
  EXPECT_EQ(names, (std::vector<std::string>{"IHDR", "acTL", "fcTL", "IDAT", "fcTL", "fdAT", "fcTL", "fdAT", "fcTL",
                                             "fdAT", "IEND"}));
  EXPECT_THROW((void)picture::animated_png({}), std::runtime_error);
  EXPECT_THROW((void)picture::animated_png({{plain(2, 2, 0), 1}, {plain(3, 2, 0), 1}}), std::runtime_error);
}

// --- the commands ---

class PictureCommands : public testing::Test {
 protected:
  PictureCommands() {
    write_grid(room(), folder_.path() / "m0.yaml");
    OccupancyGrid after = room();
    for (int column = 40; column < 60; ++column) after.set({column, 40}, CellState::kOccupied);
    write_grid(after, folder_.path() / "m1.yaml");
    mapping::store::MapStore store{folder_.path() / "store.sqlite", room()};
    MapRevision revision;
    revision.number = 1;
    revision.time = timestamp_from_ns(1'000'000'000);
    revision.changes = changes_between(room(), after);
    revision.map = std::make_shared<const OccupancyGrid>(after);
    store.append(revision, {1, 0.9, "evidence"});
    (void)folder_.write("run.tum", "0.5 0 0 0 0 0 0 1\n1.5 1 0 0 0 0 0 1\n2.5 1 1 0 0 0 1 0\n");
  }
  [[nodiscard]] std::string file(const std::string& name) const { return (folder_.path() / name).string(); }
  [[nodiscard]] Raster picture(const std::string& name) const { return decoded(content_of(folder_.path() / name)); }

  test::TemporaryFolder folder_;
};

TEST_F(PictureCommands, RefuseAPictureOfAnotherKind) {
  for (const char* name : {"p.svg", "p", "p.png.jpg"}) {
    const auto run = run_deltamap({"map", "picture", file("m0.yaml"), file(name)});
    EXPECT_EQ(run.exit_code, 1) << name;
    EXPECT_NE(run.errors.find("only PNG is written"), std::string::npos) << run.errors;
    EXPECT_FALSE(std::filesystem::exists(file(name)));
  }
  EXPECT_EQ(run_deltamap({"map", "picture", file("m0.yaml"), file("P.PNG")}).exit_code, 0);
}

TEST_F(PictureCommands, FilmARunThatHasAcceptedNothing) {
  { const mapping::store::MapStore unchanged{folder_.path() / "unchanged.sqlite", room()}; }
  const auto run =
      run_deltamap({"map", "film", file("unchanged.sqlite"), file("film.png"), "--trajectory", file("run.tum")});
  EXPECT_EQ(run.exit_code, 0) << run.errors;
  EXPECT_NE(run.errors.find("no revision was accepted; the film shows M_0"), std::string::npos) << run.errors;
  EXPECT_GT(picture("film.png").width, 0U);
}

TEST_F(PictureCommands, DrawAMapWithAllThatIsAskedFor) {
  const auto scan = folder_.write("scan.json", R"({"time": 1, "pose": {"x_m": 1, "y_m": 0, "heading_rad": 0.5},
      "state": "tracking", "verdict": "right", "ends_m": [[1.0, 0.5], [1.5, 0.5]]})");
  const auto run = run_deltamap({"map", "picture", file("m1.yaml"), file("p.png"), "--before", file("m0.yaml"),
                                 "--trajectory", file("run.tum"), "--scan", scan.string(), "--title", "hall"});
  ASSERT_EQ(run.exit_code, 0) << run.errors;
  for (const Ink& ink : {picture::kNewlyOccupied, picture::kPath, picture::kScan, picture::kRobot}) {
    EXPECT_GT(pixels_of(picture("p.png"), ink), 20u) << int{ink[0]};
  }
  EXPECT_EQ(run_deltamap({"map", "picture", file("m1.yaml"), file("q.png"), "--pose", "1,0,90"}).exit_code, 0);
  EXPECT_GT(pixels_of(picture("q.png"), picture::kRobot), 20u);
}

TEST_F(PictureCommands, RefuseWhatTheyCannotReadInOneLine) {
  const auto expect_refused = [](const std::vector<std::string>& words, int exit_code, const std::string& why) {
    const auto run = run_deltamap(words);
    EXPECT_EQ(run.exit_code, exit_code) << why;
    EXPECT_NE(run.errors.find(why), std::string::npos) << run.errors;
  };
  write_grid(test::drawn_grid({"#"}), folder_.path() / "other.yaml");
  const std::string no_scan = folder_.write("no.json", "{}").string();
  const std::string png = file("p.png");
  expect_refused({"map", "picture", file("m1.yaml"), png, "--before", file("other.yaml")}, 1, "differ in size");
  expect_refused({"map", "picture", file("m1.yaml"), png, "--scan", no_scan}, 1, "no.json");
  expect_refused({"map", "picture", file("m1.yaml"), png, "--scan", file("missing.json")}, 1, "missing.json");
  expect_refused({"map", "picture", file("m1.yaml"), png, "--pose", "1,2"}, 2, "--pose");
  expect_refused({"map", "picture", file("m1.yaml"), file("none/p.png")}, 1, "none/p.png");
  expect_refused({"map", "history", file("store.sqlite"), "picture", "0", png}, 1, "first map");
  expect_refused({"map", "history", file("store.sqlite"), "picture", "9", png}, 1, "9");
  expect_refused({"map", "film", file("store.sqlite"), png, "--trajectory", file("missing.tum")}, 1, "missing.tum");
  EXPECT_FALSE(std::filesystem::exists(png));
}

TEST_F(PictureCommands, DrawTheTwoSidesOfADelta) {
  const auto run = run_deltamap({"map", "history", file("store.sqlite"), "picture", "1", file("p.png"), "--json"});
  ASSERT_EQ(run.exit_code, 0) << run.errors;
  EXPECT_NE(run.output.find("\"cells\":20"), std::string::npos) << run.output;
  const Raster both = picture("p.png");
  std::size_t left = 0;
  std::size_t right = 0;
  for (std::size_t y = 0; y < both.height * 3 / 4; ++y) {  // above the legend
    for (std::size_t x = 0; x < both.width; ++x) {
      if (at(both, x, y) == picture::kNewlyOccupied) ++(x < both.width / 2 ? left : right);
    }
  }
  EXPECT_EQ(left, 0u);
  EXPECT_GT(right, 100u);
}

TEST_F(PictureCommands, FilmARun) {
  const auto run = run_deltamap(
      {"map", "film", file("store.sqlite"), file("film.png"), "--trajectory", file("run.tum"), "--frames", "5"});
  ASSERT_EQ(run.exit_code, 0) << run.errors;
  const std::string png = content_of(folder_.path() / "film.png");
  std::size_t frames = 0;
  for (const auto& [name, data] : chunks_of(png)) frames += name == "fcTL" ? 1 : 0;
  EXPECT_EQ(frames, 5u);
  EXPECT_GT(pixels_of(decoded(png), picture::kRobot), 20u);
}

}  // namespace
}  // namespace deltamap::tool
