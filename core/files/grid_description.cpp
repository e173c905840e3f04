// SPDX-License-Identifier: Apache-2.0
#include "core/files/grid_description.hpp"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <sstream>
#include <stdexcept>
#include <string_view>
#include <system_error>
#include <utility>

#include "core/files/grid_file.hpp"
#include "core/files/shortest_text.hpp"
#include "core/files/text_of_file.hpp"

namespace deltamap {
namespace {

constexpr double kFinest_m = 0.001;  // sides of a cell
constexpr double kCoarsest_m = 100.0;

/// The YAML reader's words, and what they mean to whoever wrote the file.
constexpr std::array<std::pair<std::string_view, std::string_view>, 6> kMeanings{{
    {"end of sequence flow not found", "a '[' is not closed"},
    {"end of map flow not found", "a '{' is not closed"},
    {"end of map not found", "the indentation does not fit the lines above"},
    {"end of sequence not found", "the indentation does not fit the lines above"},
    {"illegal map value", "a ':' is out of place"},
    {"unknown escape character", "a backslash in double quotes: write it twice, or use single quotes"},
}};

[[noreturn]] void complain(const std::filesystem::path& file, const std::string& why) {
  throw std::runtime_error(file.string() + ": " + why);
}

[[noreturn]] void complain(const std::filesystem::path& file, const YAML::Node& node, const std::string& why) {
  complain(file, "line " + std::to_string(node.Mark().line + 1) + ": " + why);
}

/// Whoever gives the picture, or another file that is no text, is told so before YAML makes a riddle of it.
void require_description(const std::filesystem::path& file, const std::string& text) {
  if (is_carmen_map(file, text)) complain(file, "is a CARMEN map; give a map_server map (YAML and PGM)");
  std::filesystem::path yaml = file;
  yaml.replace_extension(".yaml");
  std::error_code ignored;
  const bool is_beside = yaml != file && std::filesystem::exists(yaml, ignored);
  const std::string beside = is_beside ? ", " + yaml.string() : std::string{};
  if (text.starts_with("P5") || text.starts_with("P2")) {
    complain(file, "is the picture of a map; give its description (YAML)" + beside);
  }
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

/// What is missing at the end is found behind the last line.
int line_of(const YAML::Mark& mark, const std::string& text) {
  const auto breaks = std::count(text.begin(), text.end(), '\n');
  const int last = static_cast<int>(breaks) - (text.ends_with('\n') ? 1 : 0);
  return std::min(mark.line, std::max(last, 0)) + 1;
}

/// One that is open at the end of its line would take the lines below for its text.
void require_closed_quotes(const std::filesystem::path& file, const std::string& text) {
  std::istringstream lines(text);
  int line_number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++line_number;
    const auto colon = line.find(": ");
    const auto begin = colon == std::string::npos ? colon : line.find_first_not_of(' ', colon + 1);
    if (begin == std::string::npos || (line[begin] != '"' && line[begin] != '\'')) continue;
    if (line.find(line[begin], begin + 1) == std::string::npos)
      complain(file, "line " + std::to_string(line_number) + ": not YAML: a quote is not closed");
  }
}

YAML::Node tree_of(const std::filesystem::path& file, const std::string& text) {
  try {
    return YAML::Load(text);
  } catch (const YAML::Exception& error) {
    const auto* known = std::find_if(kMeanings.begin(), kMeanings.end(),
                                     [&](const auto& one) { return error.msg.starts_with(one.first); });
    complain(file, "line " + std::to_string(line_of(error.mark, text)) +
                       ": not YAML: " + (known == kMeanings.end() ? error.msg : std::string(known->second)));
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

Point2 origin_of(const YAML::Node& map, const std::filesystem::path& file) {
  const YAML::Node origin = map["origin"];
  if (!origin) complain(file, "key 'origin' is missing");
  if (!origin.IsSequence() || origin.size() < 2) complain(file, origin, "'origin' must be [x, y, yaw]");
  std::array<double, 3> values{};
  for (std::size_t i = 0; i < std::min<std::size_t>(3, origin.size()); ++i) {
    try {
      values[i] = origin[i].as<double>();
    } catch (const YAML::Exception&) {
      complain(file, origin, "'origin' must hold numbers");
    }
  }
  if (!std::isfinite(values[0]) || !std::isfinite(values[1])) complain(file, origin, "'origin' must be finite");
  if (values[2] != 0.0) {
    complain(file, origin, "a rotated origin (yaw " + std::to_string(values[2]) + ") is not supported; turn the image");
  }
  return {values[0], values[1]};
}

}  // namespace

GridDescription read_grid_description(const std::filesystem::path& file) {
  const std::string text = description_text(file);
  require_description(file, text);
  require_closed_quotes(file, text);
  const YAML::Node map = tree_of(file, text);
  if (!map.IsMap()) complain(file, "line 1: not a map description (expected 'image', 'resolution', 'origin')");
  require_each_key_once(file, map);
  GridDescription found;
  if (!map["image"]) complain(file, "key 'image' is missing");
  if (!map["image"].IsScalar()) complain(file, map["image"], "'image' must name the picture");
  found.image = map["image"].as<std::string>();
  found.resolution_m = number(map, "resolution", file);
  if (!(found.resolution_m > 0.0)) complain(file, map["resolution"], "'resolution' must be positive");
  if (found.resolution_m < kFinest_m || found.resolution_m > kCoarsest_m)
    complain(file, map["resolution"], "'resolution' must be 0.001 to 100 m");
  found.origin = origin_of(map, file);
  if (map["negate"]) found.negate = number(map, "negate", file) != 0.0;
  found.occupied_threshold = threshold(map, "occupied_thresh", found.occupied_threshold, file);
  found.free_threshold = threshold(map, "free_thresh", found.free_threshold, file);
  if (map["mode"] && map["mode"].as<std::string>("") != "trinary")
    complain(file, map["mode"], "only 'mode: trinary' is supported");
  return found;
}

}  // namespace deltamap
