// SPDX-License-Identifier: Apache-2.0
#include "tool/scenario_place.hpp"

#include <set>
#include <stdexcept>
#include <system_error>

namespace deltamap::tool {
namespace {

namespace fs = std::filesystem;

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

}  // namespace

fs::path scenario_folder() {
  const fs::path of_repository = "config/scenarios";
  std::error_code error;
  return fs::is_directory(of_repository, error) ? of_repository : fs::path(DELTAMAP_INSTALLED_SCENARIOS);
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
