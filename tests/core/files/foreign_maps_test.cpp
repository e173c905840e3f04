// SPDX-License-Identifier: Apache-2.0
// Maps in all the ways in which other programs write them, in several shapes: each is read cell for cell, or refused
// with a line that names what it is; what was guessed is told.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "core/files/grid_file.hpp"
#include "core/random.hpp"
#include "tests/support/files/map_pictures.hpp"
#include "tests/support/files/temporary_folder.hpp"

namespace deltamap {
namespace {

using namespace test::map_pictures;

struct Way {
  std::string name;
  std::function<std::string(const OccupancyGrid&)> picture;
  std::function<Keys(const OccupancyGrid&)> keys = [](const OccupancyGrid&) { return Keys{}; };
  std::string note{};     ///< a part of the only line that is told; empty: nothing is told
  std::string refusal{};  ///< a part of the refusal; empty: it is read
  bool is_exact = true;   ///< cell for cell; otherwise the line says what was taken for what
};

std::string plain(const OccupancyGrid& grid) { return binary_pgm(grid, {}); }

std::function<Keys(const OccupancyGrid&)> with(const std::function<void(Keys&)>& change) {
  return [change](const OccupancyGrid&) {
    Keys keys;
    change(keys);
    return keys;
  };
}

std::vector<Way> readable_ways() {
  const Shades deep{0, 205 * 257, 254 * 257};
  std::vector<Way> ways{
      {"binary", plain},
      {"binary, 16 bit", [=](const auto& grid) { return binary_pgm(grid, deep, 65535); }},
      {"binary, of 100",
       [](const auto& grid) {
         return binary_pgm(grid, {0, 80, 100}, 100);
       }},
      {"binary, white floor",
       [](const auto& grid) {
         return binary_pgm(grid, {0, 205, 255});
       }},
      {"text", [](const auto& grid) { return text_pgm(grid, {}); }},
      {"text, 16 bit", [=](const auto& grid) { return text_pgm(grid, deep, 65535); }},
      {"text, CR LF", [](const auto& grid) { return text_pgm(grid, {}, 255, "\r\n"); }},
      {"png, grey", [](const auto& grid) { return png_of(grid, PNG_COLOR_TYPE_GRAY); }},
      {"png, 16 bit", deep_png},
      {"png, interlaced", [](const auto& grid) { return png_of(grid, PNG_COLOR_TYPE_GRAY, false, true); }},
      {"png, colour", [](const auto& grid) { return png_of(grid, PNG_COLOR_TYPE_RGB); }},
      {"png, opaque", [](const auto& grid) { return png_of(grid, PNG_COLOR_TYPE_RGB_ALPHA); }},
      {"png, clear", [](const auto& grid) { return png_of(grid, PNG_COLOR_TYPE_RGB_ALPHA, true); }},
      {"png, grey and clear", [](const auto& grid) { return png_of(grid, PNG_COLOR_TYPE_GRAY_ALPHA, true); }},
      {"png, clear and interlaced", [](const auto& grid) { return png_of(grid, PNG_COLOR_TYPE_RGBA, true, true); }},
      {"png, palette", [](const auto& grid) { return palette_png(grid, false); }},
      {"png, clear palette", [](const auto& grid) { return palette_png(grid, true); }},
      {"tiny yaw", plain, with([](Keys& keys) { keys.origin = "[-1.5, 2.25, -1e-9]"; })},
      {"whole turn", plain, with([](Keys& keys) { keys.origin = "[-1.5, 2.25, 6.2831853]"; })},
      {"negate: false", plain, with([](Keys& keys) { keys.negate = "false"; })},
      {"negate: true",
       [](const auto& grid) {
         return binary_pgm(grid, {255, 50, 1});
       },
       with([](Keys& keys) { keys.negate = "true"; })},
      {"mode: Trinary", plain, with([](Keys& keys) { keys.more = "mode: Trinary\n"; })},
      {"description with CR LF", plain,
       with([](Keys& keys) { keys.thresholds = "occupied_thresh: 0.65\r\nfree_thresh: 0.196\r\n"; })},
      {"as nav2 saved it", plain,
       with([](Keys& keys) { keys.thresholds = "occupied_thresh: 0.65\nfree_thresh: 0.25\n"; }),
       "line 6: 'free_thresh' 0.25 would make shade 205 free: it is read as unknown"},
      {"nothing occupied by the threshold", plain,
       with([](Keys& keys) { keys.thresholds = "occupied_thresh: 1\nfree_thresh: 0.196\n"; }),
       "line 5: 'occupied_thresh' 1 would make shade 0 unknown: it is read as occupied"},
      {"swapped thresholds", plain,
       with([](Keys& keys) { keys.thresholds = "occupied_thresh: 0.196\nfree_thresh: 0.65\n"; }),
       "line 6: 'occupied_thresh' (0.196) lies below 'free_thresh' (0.65): are they swapped?"},
      {"another machine's path", plain, with([](Keys& keys) { keys.image = "/home/robot/maps/map.pgm"; }),
       "line 1: 'image' /home/robot/maps/map.pgm is not here: "},
      {"another system's path", plain, with([](Keys& keys) { keys.image = R"(C:\maps\map.pgm)"; }),
       R"(line 1: 'image' C:\maps\map.pgm is not here: )"},
      {"a key of another program", plain, with([](Keys& keys) { keys.more = "free_tresh: 0.3\n"; }),
       "line 7: 'free_tresh' is no key of a map_server map: left out"},
      {"bytes behind", [](const auto& grid) { return plain(grid) + "surplus"; }, with([](Keys&) {}),
       "7 bytes lie behind the last of "},
      {"half transparent",
       [](const auto& grid) {
         return png(grid, {.colour_type = PNG_COLOR_TYPE_GRAY_ALPHA}, [](CellState state, Bytes& row) {
           const Bytes pixel = samples(Shades{}.of(state), 1, state == CellState::kOccupied ? 128 : 255);
           row.insert(row.end(), pixel.begin(), pixel.end());
         });
       },
       with([](Keys&) {}), "pixels are half transparent"},
  };
  const std::vector<std::pair<int, std::string>> turns{{1, "1.5708"},  {1, "-4.71238898"}, {2, "3.14159265"},
                                                       {2, "-3.1416"}, {3, "-1.570796"},   {3, "4.7124"}};
  for (const auto& [quarters, yaw] : turns) {
    const auto turned = [quarters = quarters](const OccupancyGrid& grid) { return turned_back(grid, quarters); };
    ways.push_back({"turned by " + yaw, [=](const auto& grid) { return plain(turned(grid)); },
                    [quarters = quarters, yaw = yaw](const auto& grid) {
                      Keys keys;
                      keys.origin = turned_origin(grid, quarters, yaw);
                      return keys;
                    }});
  }
  return ways;
}

/// A binary PGM with another last pixel.
std::string with_last(std::string pgm, unsigned shade) {
  pgm.back() = static_cast<char>(shade);
  return pgm;
}

/// A binary PGM whose outermost pixels are of one shade.
std::string framed(std::string pgm, const OccupancyGrid& grid, char shade) {
  const auto width = static_cast<std::size_t>(grid.width());
  const auto height = static_cast<std::size_t>(grid.height());
  const std::size_t first = pgm.size() - width * height;
  for (std::size_t row = 0; row < height; ++row) {
    for (std::size_t column = 0; column < width; ++column) {
      if (row == 0 || column == 0 || row + 1 == height || column + 1 == width)
        pgm[first + row * width + column] = shade;
    }
  }
  return pgm;
}

std::vector<Way> doubtful_ways() {
  return {
      {"205 free beside white",
       [](const auto& grid) {
         return binary_pgm(grid, {0, 205, 255});
       },
       with([](Keys& keys) { keys.thresholds = "occupied_thresh: 0.65\nfree_thresh: 0.25\n"; }),
       "line 6: shade 205, map_saver's unknown, counts as free", "", false},
      {"grey that counts as free",
       [](const auto& grid) {
         return binary_pgm(grid, {0, 128, 255});
       },
       with([](Keys& keys) { keys.thresholds = "occupied_thresh: 0.65\nfree_thresh: 0.6\n"; }),
       "nothing is unknown: shade 128 of 255", "", false},
      {"grey that counts as free, but for one cell",
       [](const auto& grid) {
         return with_last(binary_pgm(grid, {0, 128, 255}), 95);
       },
       with([](Keys& keys) { keys.thresholds = "occupied_thresh: 0.65\nfree_thresh: 0.6\n"; }), "shade 128 of 255 (",
       "", false},
      {"grey that counts as occupied, but for one cell",
       [](const auto& grid) {
         return with_last(binary_pgm(grid, {0, 100, 255}), 176);
       },
       with([](Keys& keys) { keys.thresholds = "occupied_thresh: 0.55\nfree_thresh: 0.196\n"; }),
       "counts as occupied by 'occupied_thresh' 0.55", "", false},
      {"the outside in white, and the floor in 205",
       [](const auto& grid) {
         return framed(binary_pgm(grid, {0, 205, 205}), grid, '\xFE');
       },
       with([](Keys&) {}), "of the picture's edge is free", "", false},
      {"no grey at all",
       [](const auto& grid) {
         return binary_pgm(grid, {0, 254, 254});
       },
       with([](Keys&) {}), "nothing is unknown: ", "", false},
      {"negated", plain, with([](Keys& keys) { keys.negate = "1"; }), "is 'negate' (1) right?", "", false},
      {"an inverted picture",
       [](const auto& grid) {
         return binary_pgm(grid, {255, 50, 1});
       },
       with([](Keys&) {}), "is 'negate' (0) right?", "", false},
      {"thresholds left out",
       [](const auto& grid) {
         return binary_pgm(grid, {10, 205, 240});
       },
       with([](Keys& keys) { keys.thresholds.clear(); }), "'free_thresh' is not given: 0.196 is taken", "", false},
      {"brighter than it says",
       [](const auto& grid) {
         return binary_pgm(grid, {0, 150, 201}, 200);
       },
       with([](Keys&) {}), "pixels are brighter than the header's 200", "", false},
      {"coloured",
       [](const auto& grid) {
         return png(grid, {.colour_type = PNG_COLOR_TYPE_RGB}, [](CellState state, Bytes& row) {
           const Bytes pixel = state == CellState::kUnknown ? Bytes{254, 0, 254} : samples(Shades{}.of(state), 3);
           row.insert(row.end(), pixel.begin(), pixel.end());
         });
       },
       with([](Keys&) {}), "pixels are coloured", "", false},
  };
}

std::vector<Way> refused_ways() {
  const auto bytes = [](const std::string& text) { return [text](const OccupancyGrid&) { return text; }; };
  const auto cut = [](const std::string& whole) { return whole.substr(0, whole.size() - whole.size() / 3); };
  const auto origin = [](const std::string& text) { return with([text](Keys& keys) { keys.origin = text; }); };
  return {
      {"yaw of nothing", plain, origin("[-1.5, 2.25, -nan]"), "",
       "line 3: 'origin' has a -nan for its yaw, as map_saver"},
      {"yaw nan", plain, origin("[-1.5, 2.25, .nan]"), "", "line 3: 'origin' has a .nan for its yaw"},
      {"infinite origin", plain, origin("[.inf, 2.25, 0]"), "", "line 3: 'origin' must be finite"},
      {"turned", plain, origin("[-1.5, 2.25, 0.5]"), "", "line 3: a turned origin (yaw 0.5)"},
      {"a quarter in degrees", plain, origin("[-1.5, 2.25, 90]"), "",
       "line 3: the origin's yaw 90 looks like degrees, and radians are meant: 1.5708"},
      {"a half in degrees", plain, origin("[-1.5, 2.25, -180.0]"), "",
       "line 3: the origin's yaw -180 looks like degrees, and radians are meant: -3.1416"},
      {"three quarters in degrees", plain, origin("[-1.5, 2.25, 270]"), "",
       "line 3: the origin's yaw 270 looks like degrees, and radians are meant: -1.5708"},
      {"a few degrees", plain, origin("[-1.5, 2.25, 12.5]"), "",
       "line 3: the origin's yaw 12.5 looks like degrees, and radians are meant: 0.2182"},
      {"turned a little", plain, origin("[-1.5, 2.25, 2e-6]"), "", "line 3: a turned origin (yaw 2e-06)"},
      {"negate: maybe", plain, with([](Keys& keys) { keys.negate = "maybe"; }), "",
       "line 4: 'negate' must be 0 or 1, not 'maybe'"},
      {"mode: scale", plain, with([](Keys& keys) { keys.more = "mode: scale\n"; }), "", "line 7: only 'mode: trinary'"},
      {"mode: raw", plain, with([](Keys& keys) { keys.more = "mode: raw\n"; }), "", "line 7: only 'mode: trinary'"},
      {"no picture", plain, with([](Keys& keys) { keys.image = "other.pgm"; }), "", "line 1: picture "},
      {"git LFS", bytes("version https://git-lfs.github.com/spec/v1\noid sha256:00\nsize 2413\n"), with([](Keys&) {}),
       "", "is a Git LFS pointer, not the file itself: `git lfs pull` brings it"},
      {"ARIA", bytes("2D-Map\nLineMinPos: -1000 -600\n"), with([](Keys&) {}), "",
       "is a map of ARIA (Mapper3, MobileEyes)"},
      {"JPEG", bytes("\xFF\xD8\xFF\xE0"), with([](Keys&) {}), "", "is a JPEG picture: pictures of maps are PGM or PNG"},
      {"PPM", bytes("P6\n1 1\n255\nabc"), with([](Keys&) {}), "", "is a P6 picture: pictures of maps are PGM or PNG"},
      {"no picture at all", bytes("hello"), with([](Keys&) {}), "", "byte 0: neither a PGM (P5, P2) nor a PNG"},
      {"lines changed", [](const auto& grid) { return binary_pgm(grid, {}, 255, "\r\n"); }, with([](Keys&) {}), "",
       "byte 2: header lines end in CR LF"},
      {"binary, cut", [=](const auto& grid) { return cut(plain(grid)); }, with([](Keys&) {}), "", ": cut short, "},
      {"text, cut", [=](const auto& grid) { return cut(text_pgm(grid, {})); }, with([](Keys&) {}), "", ": cut short, "},
      {"png, cut", [=](const auto& grid) { return cut(png_of(grid, PNG_COLOR_TYPE_GRAY)); }, with([](Keys&) {}), "",
       "map.pgm: PNG: "},
      {"png, a flipped bit",
       [](const auto& grid) {
         std::string whole = png_of(grid, PNG_COLOR_TYPE_GRAY);
         whole[whole.find("IDAT") + 6] = static_cast<char>(whole[whole.find("IDAT") + 6] ^ 0x10);
         return whole;
       },
       with([](Keys&) {}), "", "map.pgm: PNG: "},
      {"a word among the numbers", [](const auto& grid) { return text_pgm(grid, {}).replace(20, 1, "x"); },
       with([](Keys&) {}), "", "expected a number from "},
  };
}

constexpr std::array<std::pair<int, int>, 6> kShapes{{{7, 5}, {64, 64}, {65, 40}, {130, 71}, {3, 90}, {200, 3}}};

class ForeignMaps : public testing::Test {
 protected:
  void read(const Way& way, const OccupancyGrid& grid) {
    SCOPED_TRACE(way.name + ", " + size_of(grid));
    ++maps_;
    (void)folder_.write("map.pgm", way.picture(grid));
    const auto yaml = folder_.write("map.yaml", way.keys(grid).text());
    try {
      const GridWithNotes found = read_grid_with_notes(yaml);
      EXPECT_EQ(way.refusal, "") << "it was read";
      EXPECT_TRUE(!way.is_exact || found.grid == grid);
      EXPECT_EQ(found.notes.empty(), way.note.empty()) << (found.notes.empty() ? "silent" : found.notes.front());
      EXPECT_TRUE(!way.is_exact || found.notes.size() <= 1);
      for (const std::string& note : found.notes) EXPECT_EQ(note.find(folder_.path().string()), 0u) << note;
      const auto says_so = [&](const std::string& note) { return note.find(way.note) != std::string::npos; };
      EXPECT_TRUE(found.notes.empty() || std::any_of(found.notes.begin(), found.notes.end(), says_so))
          << (found.notes.empty() ? "" : found.notes.front());
      EXPECT_GT(shown_cells(yaml), 0u);
    } catch (const std::runtime_error& error) {
      const std::string why = error.what();
      EXPECT_NE(way.refusal, "") << why;
      EXPECT_NE(why.find(way.refusal), std::string::npos) << why;
      EXPECT_EQ(why.find('\n'), std::string::npos);
    }
  }

  test::TemporaryFolder folder_;
  int maps_ = 0;
};

TEST_F(ForeignMaps, AreReadCellForCellOrNamedInAllTheirWaysAndShapes) {
  std::uint64_t seed = 1;
  for (const auto& ways : {readable_ways(), doubtful_ways(), refused_ways()}) {
    for (const Way& way : ways) {
      for (const auto& [width, height] : kShapes) read(way, building(width, height, seed++));
    }
  }
  EXPECT_GE(maps_, 200);
}

TEST_F(ForeignMaps, HaveAnUnknownThatStrayCellsDoNotMake) {
  const auto notes_with = [&](int unknown) {
    OccupancyGrid drawn{{200, 200, 0.05, {0.0, 0.0}}, CellState::kFree};
    drawn.set({100, 100}, CellState::kOccupied);
    for (int i = 0; i < unknown; ++i) drawn.set({50 + i % 10, 50 + i / 10}, CellState::kUnknown);
    (void)folder_.write("map.pgm", plain(drawn));
    return read_grid_with_notes(folder_.write("map.yaml", Keys{}.text())).notes;
  };
  ASSERT_EQ(notes_with(1).size(), 1u);
  EXPECT_NE(notes_with(1)[0].find("hardly anything is unknown (1 cell): "), std::string::npos) << notes_with(1)[0];
  EXPECT_TRUE(notes_with(100).empty()) << "a drawn patch";
}

TEST_F(ForeignMaps, OfAnotherTurnAreToldTheOriginOfTheTurnedPicture) {
  (void)folder_.write("map.pgm", "P5 40 20 255\n" + std::string(800, '\xFE'));
  const auto yaml = folder_.write("map.yaml", "image: map.pgm\nresolution: 0.5\norigin: [1, 2, 0.523598776]\n");
  try {
    (void)read_grid(yaml);
    FAIL() << "it was read";
  } catch (const std::runtime_error& error) {
    EXPECT_EQ(std::string(error.what()),
              yaml.string() +
                  ": line 3: a turned origin (yaw 0.523598776) is read for quarter turns alone: turn the picture by 30 "
                  "degrees counterclockwise onto a canvas that holds it whole, its corners unknown (205), and set "
                  "'origin: [-4, 2, 0]'");
  }
}

}  // namespace
}  // namespace deltamap
