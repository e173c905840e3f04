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
    {"mapping/awareness", {"mapping/alignment", "mapping/merge"}},
    {"mapping/alignment", {"mapping/awareness", "mapping/merge"}},
    {"mapping/merge", {"mapping/awareness"}},
};

bool lies_under(const std::string& path, const std::string& folder) { return path.rfind(folder + "/", 0) == 0; }

std::string wing_of(const std::string& path) {
  return lies_under(path, "daemon/tool") ? "daemon/tool" : path.substr(0, path.find('/'));
}

bool is_allowed(const std::string& from, const std::string& to) {
  for (const auto& [folder, forbidden] : kForbiddenInside) {
    if (!lies_under(from, folder)) continue;
    for (const auto& other : forbidden) {
      if (lies_under(to, other)) return false;
    }
  }
  const std::string wing = wing_of(from);
  if (wing_of(to) == wing) return true;
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
  EXPECT_TRUE(is_allowed("daemon/tool/sim.cpp", "simulation/world.hpp"));
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
