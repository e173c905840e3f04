// SPDX-License-Identifier: Apache-2.0
#include "core/files/grid_description.hpp"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <set>
#include <stdexcept>
#include <system_error>

#include "core/files/foreign_file.hpp"
#include "core/files/shortest_text.hpp"
#include "core/files/text_of_file.hpp"
#include "core/files/yaml_tree.hpp"

namespace deltamap {
namespace {

constexpr double kFinest_m = 0.001;  // sides of a cell
constexpr double kCoarsest_m = 100.0;

[[noreturn]] void complain(const std::filesystem::path& file, const std::string& why) {
  throw std::runtime_error(file.string() + ": " + why);
}

[[noreturn]] void complain(const std::filesystem::path& file, const YAML::Node& node, const std::string& why) {
  complain(file, "line " + std::to_string(node.Mark().line + 1) + ": " + why);
}

bool is_picture(const std::string& text) {
  return text.starts_with("P5") || text.starts_with("P2") || text.starts_with("\x89PNG");
}

/// Whoever gives the picture, or another file that is none of YAML, is told so before YAML makes a riddle of it.
void require_description(const std::filesystem::path& file, const std::string& text) {
  if (const std::string kind = foreign_kind(file, text, WantedFile::kMap); !kind.empty()) complain(file, kind);
  std::filesystem::path yaml = file;
  yaml.replace_extension(".yaml");
  std::error_code ignored;
  const bool is_beside = yaml != file && std::filesystem::exists(yaml, ignored);
  const std::string beside = is_beside ? ", " + yaml.string() : std::string{};
  if (is_picture(text)) complain(file, "is the picture of a map; give its description (YAML)" + beside);
  const auto binary = std::find_if(text.begin(), text.end(), [](char c) {
    return static_cast<unsigned char>(c) < 0x20 && c != '\t' && c != '\n' && c != '\r';
  });
  if (binary != text.end()) {
    complain(file, "byte " + std::to_string(binary - text.begin()) + ": is no text; give a map's description (YAML)");
  }
}

std::string description_text(const std::filesystem::path& file) {
  std::error_code told_below;
  if (std::filesystem::is_other(file, told_below))
    complain(file, "is no plain file");  // a pipe may say nothing for ever
  try {
    return text_of_file(file);
  } catch (const std::runtime_error& error) {
    complain(file, error.what());
  }
}

YAML::Node tree_of(const std::filesystem::path& file, const std::string& text) {
  try {
    return only_yaml_tree(text);
  } catch (const YAML::Exception& error) {
    complain(file, placed_meaning_of(error, text));
  }
}

void require_each_key_once(const std::filesystem::path& file, const YAML::Node& map) {
  std::set<std::string> names;
  for (const auto& entry : map) {
    if (!entry.first.IsScalar()) complain(file, entry.first, "a key must be a word");
    const std::string& name = entry.first.Scalar();
    if (!names.insert(name).second) complain(file, entry.first, "'" + name + "' is given twice");
  }
}

double number(const YAML::Node& map, const std::string& key, const std::filesystem::path& file) {
  const YAML::Node node = map[key];
  if (!node) complain(file, "key '" + key + "' is missing");
  try {
    const auto value = node.as<double>();
    if (std::isfinite(value)) return value;
  } catch (const YAML::Exception&) {  // told below, with the line
  }
  complain(file, node, "'" + key + "' is not a number");
}

double threshold(const YAML::Node& map, const std::string& key, double otherwise, const std::filesystem::path& file) {
  if (!map[key]) return otherwise;
  const double value = number(map, key, file);
  if (value >= 0.0 && value <= 1.0) return value;
  complain(file, map[key],
           "'" + key + "' must be 0 to 1, not " + shortest_text(value) + (value > 1.0 ? " (percent?)" : ""));
}

bool is_not_a_number(const YAML::Node& node) {
  std::string word = node.IsScalar() ? node.Scalar() : "";
  std::transform(word.begin(), word.end(), word.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return word.find("nan") != std::string::npos && word.size() <= 4;  // nan, -nan, .nan
}

void read_origin(const YAML::Node& map, const std::filesystem::path& file, GridDescription& found) {
  const YAML::Node origin = map["origin"];
  if (!origin) complain(file, "key 'origin' is missing");
  if (!origin.IsSequence() || origin.size() < 2 || origin.size() > 3)
    complain(file, origin, "'origin' must be [x, y, yaw]");
  std::array<double, 3> values{};
  for (std::size_t i = 0; i < origin.size(); ++i) {
    if (is_not_a_number(origin[i])) {
      complain(file, origin,
               "'origin' has a " + origin[i].Scalar() +
                   (i == 2 ? " for its yaw, as map_saver writes where a map has no orientation: 0 is meant" : ""));
    }
    try {
      values[i] = origin[i].as<double>();
    } catch (const YAML::Exception&) {
      complain(file, origin, "'origin' must hold numbers");
    }
    if (!std::isfinite(values[i])) complain(file, origin, "'origin' must be finite");
  }
  found.origin = {values[0], values[1]};
  found.yaw_rad = values[2];
}

bool negate_of(const YAML::Node& node, const std::filesystem::path& file) {
  const std::string word = node.IsScalar() ? node.Scalar() : "";
  try {
    if (const auto value = node.as<double>(); value == 0.0 || value == 1.0) return value == 1.0;
  } catch (const YAML::Exception&) {
    try {
      return node.as<bool>();           // false, true, no, yes
    } catch (const YAML::Exception&) {  // told below
    }
  }
  complain(file, node, "'negate' must be 0 or 1, not '" + word + "'");
}

/// Names are of whoever wrote the file, on any system; a picture that is not there may have come along.
void find_picture(const std::string& image, const std::filesystem::path& file, GridDescription& found) {
  found.picture = file.parent_path() / image;  // an absolute path stands for itself
  std::error_code ignored;
  if (image.empty() || std::filesystem::exists(found.picture, ignored)) return;
  const std::string name = image.substr(image.find_last_of("/\\") + 1);
  const std::filesystem::path beside = file.parent_path() / name;
  if (name == image || name.empty() || !std::filesystem::exists(beside, ignored)) return;
  found.picture = beside;
  found.notes.push_back(file.string() + ": line " + std::to_string(found.lines.image) + ": 'image' " + image +
                        " is not here: " + beside.string() + " is read");
}

constexpr std::array kKeys{"image", "resolution", "origin", "negate", "occupied_thresh", "free_thresh", "mode"};

void note_unknown_keys(const YAML::Node& map, const std::filesystem::path& file, GridDescription& found) {
  for (const auto& entry : map) {
    const std::string& name = entry.first.Scalar();
    if (std::find(kKeys.begin(), kKeys.end(), name) != kKeys.end()) continue;
    found.notes.push_back(file.string() + ": line " + std::to_string(entry.first.Mark().line + 1) + ": '" + name +
                          "' is no key of a map_server map: left out");
  }
}

void require_trinary(const YAML::Node& map, const std::filesystem::path& file) {
  if (!map["mode"]) return;
  std::string mode = map["mode"].as<std::string>("");
  std::transform(mode.begin(), mode.end(), mode.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (mode != "trinary") complain(file, map["mode"], "only 'mode: trinary' is supported");
}

int line_of_key(const YAML::Node& map, const char* key) { return map[key] ? map[key].Mark().line + 1 : 0; }

}  // namespace

GridDescription read_grid_description(const std::filesystem::path& file) {
  const std::string text = description_text(file);
  require_description(file, text);
  const YAML::Node map = tree_of(file, text);
  if (!map.IsMap()) complain(file, "line 1: not a map description (expected 'image', 'resolution', 'origin')");
  require_each_key_once(file, map);
  GridDescription found;
  found.lines = {line_of_key(map, "image"), line_of_key(map, "origin"), line_of_key(map, "negate"),
                 line_of_key(map, "occupied_thresh"), line_of_key(map, "free_thresh")};
  if (!map["image"]) complain(file, "key 'image' is missing");
  if (!map["image"].IsScalar()) complain(file, map["image"], "'image' must name the picture");
  found.resolution_m = number(map, "resolution", file);
  if (!(found.resolution_m > 0.0)) complain(file, map["resolution"], "'resolution' must be positive");
  if (found.resolution_m < kFinest_m || found.resolution_m > kCoarsest_m)
    complain(file, map["resolution"], "'resolution' must be 0.001 to 100 m");
  read_origin(map, file, found);
  if (map["negate"]) found.negate = negate_of(map["negate"], file);
  found.occupied_threshold = threshold(map, "occupied_thresh", found.occupied_threshold, file);
  found.free_threshold = threshold(map, "free_thresh", found.free_threshold, file);
  require_trinary(map, file);
  find_picture(map["image"].as<std::string>(), file, found);
  note_unknown_keys(map, file, found);
  return found;
}

}  // namespace deltamap
