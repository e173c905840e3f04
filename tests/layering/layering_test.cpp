// SPDX-License-Identifier: Apache-2.0
// Reads every #include of the house and holds it against the arrows of docs/architecture.md; and the first line of
// every file against the licence.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include "tests/support/files/source_tree.hpp"

namespace {

namespace fs = std::filesystem;

const fs::path kRoot = deltamap::test::source_path("");

// A wing, or a room that is named here by itself, may include itself and these. `simulation` may use of the drivers
// only the device codecs.
const std::map<std::string, std::set<std::string>> kArrows = {
    {"core", {}},
    {"drivers", {"core"}},
    {"localization", {"core"}},
    {"mapping", {"core"}},
    {"surveying", {"core", "localization", "mapping"}},
    {"navigation", {"core"}},
    {"simulation", {"core", "drivers/pioneer", "drivers/lms200"}},
    {"daemon", {"core", "drivers", "localization", "mapping", "surveying", "navigation"}},
    {"reports", {"core", "daemon"}},
    {"experiments",
     {"core", "drivers", "localization", "mapping", "surveying", "navigation", "daemon", "simulation", "reports"}},
    {"tool",
     {"core", "drivers", "localization", "mapping", "surveying", "navigation", "daemon", "simulation", "reports"}},
    {"tool/lab", {"daemon", "experiments", "tool"}},
};

// The parts of a wing that know no port, no thread and no other device.
const std::map<std::string, std::set<std::string>> kForbiddenInside = {
    {"drivers/pioneer", {"drivers/port", "drivers/lms200", "drivers/carmen"}},
    {"drivers/lms200", {"drivers/port", "drivers/pioneer", "drivers/carmen"}},
    {"drivers/port", {"drivers/pioneer", "drivers/lms200", "drivers/carmen"}},
    {"daemon", {"drivers/carmen"}},
};

bool lies_under(const std::string& path, const std::string& folder) { return path.rfind(folder + "/", 0) == 0; }

std::string wing_of(const std::string& path) { return path.substr(0, path.find('/')); }
std::string room_of(const std::string& path) { return path.substr(0, path.rfind('/')); }

bool is_allowed(const std::string& from, const std::string& to) {
  for (const auto& [folder, forbidden] : kForbiddenInside) {
    if (!lies_under(from, folder)) continue;
    for (const auto& other : forbidden) {
      if (lies_under(to, other)) return false;
    }
  }
  const auto holder_of = [](const std::string& path) {
    return kArrows.contains(room_of(path)) ? room_of(path) : wing_of(path);
  };
  if (holder_of(to) == holder_of(from)) return true;
  const auto& arrows = kArrows.at(holder_of(from));
  return std::any_of(arrows.begin(), arrows.end(), [&](const auto& target) { return lies_under(to, target); });
}

std::vector<fs::path> sources_of(const std::string& folder) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(kRoot / folder)) {
    const auto extension = entry.path().extension();
    if (extension == ".cpp" || extension == ".hpp") files.push_back(entry.path());
  }
  return files;
}

const std::vector<std::string> kWings = {"core",      "drivers",     "localization", "mapping",
                                         "surveying", "navigation",  "simulation",   "daemon",
                                         "reports",   "experiments", "tool"};

struct Include {
  std::string from;
  std::string to;
  std::string place;  // file and line
};

std::vector<Include> includes_of(const std::string& wing) {
  const std::regex ours{R"re(^\s*#\s*include\s+"([^"]+)")re"};
  std::vector<Include> includes;
  for (const auto& file : sources_of(wing)) {
    const std::string from = fs::relative(file, kRoot).string();
    std::ifstream in(file);
    int number = 0;
    for (std::string line; std::getline(in, line);) {
      ++number;
      std::smatch match;
      if (std::regex_search(line, match, ours))
        includes.push_back({from, match[1], from + ":" + std::to_string(number)});
    }
  }
  return includes;
}

// The rooms (folders) that each room of a wing includes.
using Rooms = std::map<std::string, std::set<std::string>>;

Rooms rooms_of(const std::string& wing) {
  Rooms rooms;
  for (const auto& [from, to, place] : includes_of(wing)) {
    if (wing_of(to) == wing && room_of(to) != room_of(from)) rooms[room_of(from)].insert(room_of(to));
  }
  return rooms;
}

// Takes away, again and again, what includes no other room that is left: what stays is or leads into a circle.
Rooms circles_of(Rooms rooms) {
  for (bool changed = true; changed;) {
    changed = false;
    for (auto room = rooms.begin(); room != rooms.end();) {
      std::erase_if(room->second, [&](const std::string& other) { return !rooms.contains(other); });
      changed = changed || room->second.empty();
      room = room->second.empty() ? rooms.erase(room) : std::next(room);
    }
  }
  return rooms;
}

TEST(Layering, EveryIncludePointsAlongTheArrows) {
  std::size_t includes = 0;
  for (const auto& wing : kWings) {
    for (const auto& [from, to, place] : includes_of(wing)) {
      ++includes;
      EXPECT_TRUE(fs::exists(kRoot / to)) << place << ": include from the root: " << to;
      EXPECT_TRUE(is_allowed(from, to)) << place << ": must not include " << to;
    }
  }
  EXPECT_GT(includes, 10u) << "the test must have read something";
}

TEST(Layering, TheRoomsOfAWingIncludeEachOtherInNoCircle) {
  for (const auto& wing : kWings) {
    for (const auto& [room, others] : circles_of(rooms_of(wing))) {
      for (const auto& other : others) ADD_FAILURE() << room << " includes " << other << ", which leads back";
    }
  }
}

// What is ours: the rooms of these wings, and what each may include. The front doors beside the rooms may include all
// of them.
const std::vector<std::string> kOurs = {"localization", "mapping", "surveying"};
const Rooms kRoomArrows = {
    {"localization/motion", {}},
    {"localization/odometer", {"localization/motion"}},
    {"localization/sensor", {"localization/motion"}},
    {"localization/particles", {"localization/motion", "localization/sensor"}},
    {"localization/surfaces", {"localization/motion", "localization/sensor"}},
    {"localization/tracking",
     {"localization/motion", "localization/sensor", "localization/particles", "localization/surfaces"}},
    {"localization/hypotheses", {"localization/motion", "localization/sensor"}},
    {"localization/belief", {"localization/sensor", "localization/particles", "localization/hypotheses"}},
    {"mapping/registration", {}},
    {"mapping/scan_set", {}},
    {"mapping/merge", {"mapping/registration"}},
    {"mapping/alignment", {"mapping/registration"}},
    {"mapping/paper", {"mapping/alignment", "mapping/registration", "mapping/scan_set", "mapping/merge"}},
    {"mapping/votes", {}},
    {"mapping/evidence", {"mapping/scan_set", "mapping/votes"}},
    {"mapping/redraw", {"mapping/registration", "mapping/scan_set", "mapping/votes"}},
    {"mapping/gate", {}},
    {"mapping/store", {}},
    {"mapping/things", {}},
    {"mapping/bays", {}},
    {"surveying/calibration", {}},
    {"surveying/grid_registration", {}},
    {"surveying/quality", {}},
    {"surveying/slam", {}},
};

TEST(Layering, RoomsOfOursIncludeWhatIsDrawnAndStandAmongFewArrows) {
  for (const std::string& wing : kOurs) {
    std::size_t arrows = 0;
    for (const auto& [room, others] : rooms_of(wing)) {
      if (room == wing) continue;
      ASSERT_TRUE(kRoomArrows.contains(room)) << room;
      arrows += others.size();
      for (const auto& other : others) EXPECT_TRUE(kRoomArrows.at(room).contains(other)) << room << " → " << other;
    }
    EXPECT_LE(arrows, 15u) << wing;
  }
}

TEST(Layering, EveryRoomOfOursIsANamespace) {
  for (const std::string& wing : kOurs) {
    for (const auto& file : sources_of(wing)) {
      const std::string path = fs::relative(file, kRoot).string();
      const std::string name = "deltamap::" + std::regex_replace(room_of(path), std::regex{"/"}, "::");
      std::ifstream in(file);
      const std::string text{std::istreambuf_iterator<char>(in), {}};
      EXPECT_NE(text.find("namespace " + name + " {"), std::string::npos) << path << ": " << name;
    }
  }
}

/// In the folder of the tests that mirrors the source's own, by the name of the source.
fs::path test_of(const std::string& source) {
  const fs::path path{source};
  return kRoot / "tests" / path.parent_path() / (path.stem().string() + "_test.cpp");
}

std::string first_include_of(const fs::path& file) {
  const std::regex include{R"re(^\s*#\s*include\s+["<]([^">]+))re"};
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) {
    std::smatch match;
    if (std::regex_search(line, match, include)) return match[1];
  }
  return "";
}

TEST(Layering, EverySourceOfOursHasItsTest) {
  for (const std::string& wing : kOurs) {
    std::ifstream in(kRoot / "tests" / wing / "CMakeLists.txt");
    const std::string programs{std::istreambuf_iterator<char>(in), {}};
    for (const auto& file : sources_of(wing)) {
      if (file.extension() != ".cpp") continue;
      const std::string source = fs::relative(file, kRoot).string();
      const fs::path test = test_of(source);
      EXPECT_TRUE(fs::exists(test)) << source << " has no test " << fs::relative(test, kRoot).string();
      const std::string named = fs::relative(test, kRoot / "tests" / wing).string();
      EXPECT_NE(programs.find(named), std::string::npos) << named << " is built into no test program";
      const std::string header = fs::path{source}.replace_extension(".hpp").string();
      if (fs::exists(kRoot / header)) {
        EXPECT_EQ(first_include_of(test), header) << fs::relative(test, kRoot).string();
      }
    }
  }
}

TEST(Layering, FindsACircleOfThreeRooms) {
  const Rooms circle = circles_of({{"a", {"b"}}, {"b", {"c", "d"}}, {"c", {"a"}}, {"d", {"e"}}});
  EXPECT_EQ(circle, (Rooms{{"a", {"b"}}, {"b", {"c"}}, {"c", {"a"}}}));
}

TEST(Layering, RefusesArrowsThatAreNotDrawn) {
  EXPECT_FALSE(is_allowed("localization/localizer.cpp", "mapping/map_update.hpp"));
  EXPECT_FALSE(is_allowed("core/channel.hpp", "drivers/session.hpp"));
  EXPECT_FALSE(is_allowed("daemon/pipeline.cpp", "simulation/world/world.hpp"));
  EXPECT_FALSE(is_allowed("daemon/pipeline.cpp", "tool/run_tool.hpp"));
  EXPECT_FALSE(is_allowed("daemon/pipeline.cpp", "drivers/carmen/carmen_log.hpp"));
  EXPECT_FALSE(is_allowed("experiments/registry.cpp", "tool/run_tool.hpp"));
  EXPECT_FALSE(is_allowed("drivers/pioneer/session.cpp", "drivers/port/serial_port.hpp"));
  EXPECT_FALSE(is_allowed("simulation/devices/virtual_pioneer.cpp", "drivers/port/serial_port.hpp"));
  EXPECT_FALSE(is_allowed("daemon/pipeline.cpp", "reports/svg_chart.hpp"));
  EXPECT_TRUE(is_allowed("tool/tune/sweep.cpp", "reports/svg_chart.hpp"));
  EXPECT_TRUE(is_allowed("tool/sim.cpp", "simulation/world/world.hpp"));
  EXPECT_FALSE(is_allowed("tool/replay.cpp", "experiments/registry.hpp"));
  EXPECT_FALSE(is_allowed("tool/replay.cpp", "tool/lab/run_lab.hpp"));
  EXPECT_FALSE(is_allowed("mapping/map_update.cpp", "surveying/slam/slam.hpp"));
  EXPECT_TRUE(is_allowed("tool/lab/run_lab.cpp", "experiments/registry.hpp"));
  EXPECT_TRUE(is_allowed("simulation/devices/virtual_pioneer.cpp", "drivers/pioneer/packet.hpp"));
}

TEST(Layering, ThirdPartyTypesStayInsideTheirRooms) {
  // Header prefix → where it may be included. Headers of ours expose only the standard library and Eigen (and Asio in
  // drivers and daemon).
  const std::regex foreign{R"re(^\s*#\s*include\s+<(opencv2|cholmod|sqlite3|png|yaml-cpp|nlohmann|CLI)[/.])re"};
  for (const auto& wing : kWings) {
    for (const auto& file : sources_of(wing)) {
      if (file.extension() != ".hpp") continue;
      std::ifstream in(file);
      for (std::string line; std::getline(in, line);) {
        EXPECT_FALSE(std::regex_search(line, foreign)) << fs::relative(file, kRoot).string() << ": " << line;
      }
    }
  }
}

TEST(Layering, EveryFileOpensWithItsLicenceLine) {
  auto wings = kWings;
  wings.emplace_back("tests");
  for (const auto& wing : wings) {
    for (const auto& file : sources_of(wing)) {
      std::ifstream in(file);
      std::string line;
      std::getline(in, line);
      EXPECT_EQ(line, "// SPDX-License-Identifier: Apache-2.0") << fs::relative(file, kRoot).string();
    }
  }
}

TEST(Layering, NoFileIsLongerThanFourHundredLines) {
  for (const auto& wing : kWings) {
    for (const auto& file : sources_of(wing)) {
      std::ifstream in(file);
      const auto lines = std::count(std::istreambuf_iterator<char>(in), {}, '\n');
      EXPECT_LE(lines, 400) << fs::relative(file, kRoot).string();
    }
  }
}

}  // namespace
