// SPDX-License-Identifier: Apache-2.0
#include "tool/scenario_place.hpp"

#include <set>
#include <stdexcept>
#include <system_error>

namespace deltamap::tool {
namespace {

namespace fs = std::filesystem;

constexpr const char* kInTree = "config/scenarios";
constexpr int kBuildDepth = 5;  // build/PRESET/tests/ROOM/PROGRAM at most

std::string names_in(const fs::path& folder) {
  std::set<std::string> names;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    if (entry.path().extension() == ".yaml") names.insert(entry.path().stem().string());
  }
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text.empty() ? "no scenario" : text;
}

/// Of the source tree that the program was built in; empty where it stands in none.
fs::path scenarios_of_source_tree(const fs::path& program) {
  std::error_code error;
  fs::path folder = program.parent_path();
  for (int up = 0; up < kBuildDepth && !folder.empty(); ++up, folder = folder.parent_path()) {
    fs::path scenarios = folder / kInTree;
    if (fs::is_directory(scenarios, error)) return scenarios;
  }
  return {};
}

}  // namespace

fs::path scenario_folder(const fs::path& program) {
  std::error_code error;
  if (fs::is_directory(kInTree, error)) return kInTree;
  fs::path built_in = scenarios_of_source_tree(program);
  return built_in.empty() ? fs::path(DELTAMAP_INSTALLED_SCENARIOS) : built_in;
}

fs::path scenario_folder() {
  std::error_code error;
  return scenario_folder(fs::read_symlink("/proc/self/exe", error));
}

fs::path scenario_file(const std::string& given) {
  fs::path path = given;
  std::error_code error;
  if (fs::exists(path, error) || path.has_parent_path() || path.has_extension()) return path;
  const fs::path folder = scenario_folder();
  fs::path delivered = folder / (given + ".yaml");
  if (fs::exists(delivered, error)) return delivered;
  throw std::runtime_error(given + ": no such file, and no scenario: " + folder.string() + " has " + names_in(folder));
}

}  // namespace deltamap::tool
