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

namespace {

namespace fs = std::filesystem;

const fs::path kRoot = DELTAMAP_SOURCE_DIR;

// A wing may include itself and these. `simulation` may use of the drivers only the device codecs.
const std::map<std::string, std::set<std::string>> kArrows = {
    {"core", {}},
    {"drivers", {"core"}},
    {"localization", {"core"}},
    {"mapping", {"core"}},
    {"navigation", {"core"}},
    {"simulation", {"core", "drivers/pioneer", "drivers/lms200"}},
    {"daemon", {"core", "drivers", "localization", "mapping", "navigation"}},
    {"daemon/tool", {"core", "drivers", "localization", "mapping", "navigation", "daemon", "simulation"}},
};

// The parts of a wing that know no port, no thread and no other device.
const std::map<std::string, std::set<std::string>> kForbiddenInside = {
    {"drivers/pioneer", {"drivers/port", "drivers/lms200"}},
    {"drivers/lms200", {"drivers/port", "drivers/pioneer"}},
    {"drivers/port", {"drivers/pioneer", "drivers/lms200"}},
};

// The rooms of the two large wings: each may include itself and these. The front doors beside the rooms may include
// every room of their wing, and no room includes a front door.
const std::map<std::string, std::map<std::string, std::set<std::string>>> kRooms = {
    {"localization",
     {{"motion", {}},
      {"sensor", {"motion"}},
      {"particles", {"motion", "sensor"}},
      {"surfaces", {"motion", "sensor"}},
      {"tracking", {"motion", "sensor", "particles", "surfaces"}},
      {"hypotheses", {"motion", "sensor"}},
      {"belief", {"sensor", "particles", "hypotheses"}}}},
    {"mapping",
     {{"registration", {}},
      {"scan_set", {}},
      {"merge", {"registration"}},
      {"grid_registration", {"registration", "merge"}},
      {"paper", {"registration", "scan_set", "merge"}},
      {"votes", {}},
      {"evidence", {"scan_set", "votes"}},
      {"redraw", {"registration", "scan_set", "votes"}},
      {"gate", {}},
      {"store", {}}}},
};

bool lies_under(const std::string& path, const std::string& folder) { return path.rfind(folder + "/", 0) == 0; }

std::string wing_of(const std::string& path) {
  return lies_under(path, "daemon/tool") ? "daemon/tool" : path.substr(0, path.find('/'));
}

/// The folder of a file below its wing; empty for a front door.
std::string room_of(const std::string& path) {
  const auto first = path.find('/');
  const auto last = path.rfind('/');
  return first == last ? "" : path.substr(first + 1, last - first - 1);
}

bool is_allowed_among_rooms(const std::string& wing, const std::string& from, const std::string& to) {
  const std::string room = room_of(from);
  if (room.empty()) return true;
  const std::string other = room_of(to);
  return other == room || kRooms.at(wing).at(room).count(other) > 0;
}

bool is_allowed(const std::string& from, const std::string& to) {
  for (const auto& [folder, forbidden] : kForbiddenInside) {
    if (!lies_under(from, folder)) continue;
    for (const auto& other : forbidden) {
      if (lies_under(to, other)) return false;
    }
  }
  const std::string wing = wing_of(from);
  if (wing_of(to) == wing) return kRooms.count(wing) == 0 || is_allowed_among_rooms(wing, from, to);
  const auto& arrows = kArrows.at(wing);
  return std::any_of(arrows.begin(), arrows.end(), [&](const auto& target) {
    return lies_under(to, target) && (wing == "daemon/tool" || !lies_under(to, "daemon/tool"));
  });
}

std::vector<fs::path> sources_of(const std::string& folder) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(kRoot / folder)) {
    const auto extension = entry.path().extension();
    if (extension == ".cpp" || extension == ".hpp") files.push_back(entry.path());
  }
  return files;
}

const std::vector<std::string> kWings = {"core",       "drivers",    "localization", "mapping",
                                         "navigation", "simulation", "daemon"};

TEST(Layering, EveryIncludePointsAlongTheArrows) {
  const std::regex ours{R"re(^\s*#\s*include\s+"([^"]+)")re"};
  int includes = 0;
  for (const auto& wing : kWings) {
    for (const auto& file : sources_of(wing)) {
      const std::string from = fs::relative(file, kRoot).string();
      std::ifstream in(file);
      int number = 0;
      for (std::string line; std::getline(in, line);) {
        ++number;
        std::smatch match;
        if (!std::regex_search(line, match, ours)) continue;
        const std::string to = match[1];
        ++includes;
        EXPECT_TRUE(fs::exists(kRoot / to)) << from << ":" << number << ": include from the root: " << to;
        EXPECT_TRUE(is_allowed(from, to)) << from << ":" << number << ": must not include " << to;
      }
    }
  }
  EXPECT_GT(includes, 10) << "the test must have read something";
}

TEST(Layering, RefusesArrowsThatAreNotDrawn) {
  EXPECT_FALSE(is_allowed("localization/localizer.cpp", "mapping/map_update.hpp"));
  EXPECT_FALSE(is_allowed("core/channel.hpp", "drivers/session.hpp"));
  EXPECT_FALSE(is_allowed("daemon/pipeline.cpp", "simulation/world.hpp"));
  EXPECT_FALSE(is_allowed("daemon/pipeline.cpp", "daemon/tool/run_tool.hpp"));
  EXPECT_FALSE(is_allowed("drivers/pioneer/session.cpp", "drivers/port/serial_port.hpp"));
  EXPECT_FALSE(is_allowed("simulation/devices/virtual_pioneer.cpp", "drivers/port/serial_port.hpp"));
  EXPECT_FALSE(is_allowed("localization/sensor/weighing.cpp", "localization/surfaces/surface.hpp"));
  EXPECT_FALSE(is_allowed("localization/motion/deskew.cpp", "localization/localizer_params.hpp"));
  EXPECT_TRUE(is_allowed("localization/localizer.cpp", "localization/tracking/tracker.hpp"));
  EXPECT_TRUE(is_allowed("daemon/tool/sim.cpp", "simulation/world.hpp"));
  EXPECT_TRUE(is_allowed("simulation/devices/virtual_pioneer.cpp", "drivers/pioneer/packet.hpp"));
}

TEST(Layering, RoomsStandInNoCircleAndAmongFewArrows) {
  for (const auto& [wing, rooms] : kRooms) {
    std::size_t arrows = 0;
    for (const auto& [room, targets] : rooms) arrows += targets.size();
    EXPECT_LE(arrows, 15U) << wing;
    // Rooms that only include placed ones can be placed; a circle never can.
    std::set<std::string> placed;
    for (std::size_t round = 0; round < rooms.size(); ++round) {
      for (const auto& [room, targets] : rooms) {
        if (std::includes(placed.begin(), placed.end(), targets.begin(), targets.end())) placed.insert(room);
      }
    }
    for (const auto& [room, targets] : rooms) EXPECT_EQ(placed.count(room), 1U) << wing << "/" << room;
  }
}

TEST(Layering, EveryRoomIsAFolderOfItsOwnNamespace) {
  for (const auto& [wing, arrows] : kRooms) {
    std::set<std::string> folders;
    for (const auto& file : sources_of(wing)) {
      const std::string path = fs::relative(file, kRoot).string();
      const std::string room = room_of(path);
      if (room.empty()) continue;
      folders.insert(room);
      std::ifstream in(file);
      const std::string text{std::istreambuf_iterator<char>(in), {}};
      EXPECT_NE(text.find("namespace deltamap::" + wing + "::" + room + " {"), std::string::npos) << path;
    }
    std::set<std::string> rooms;
    for (const auto& [room, targets] : arrows) rooms.insert(room);
    EXPECT_EQ(folders, rooms) << wing;
  }
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
