// SPDX-License-Identifier: Apache-2.0
#include "daemon/site/place_list.hpp"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <set>
#include <stdexcept>
#include <utility>

#include "core/files/shortest_text.hpp"
#include "core/files/yaml_tree.hpp"
#include "daemon/settings/reader/text_character.hpp"
#include "daemon/settings/reader/yaml_text.hpp"

namespace deltamap::daemon {
namespace {

[[noreturn]] void refuse_place(const YAML::Node& node, const std::string& file, const std::string& why) {
  throw std::runtime_error(file + ": line " + std::to_string(node.Mark().line + 1) + ": " + why);
}

std::string word_in(const YAML::Node& node, const std::string& file, const std::string& key) {
  if (!node.IsScalar() || node.Scalar().empty()) refuse_place(node, file, "'" + key + "' must be a word or a number");
  return node.Scalar();
}

double coordinate_in(const YAML::Node& node, const YAML::Node& corner, const std::string& file) {
  double value = NAN;
  if (node && node.IsScalar()) {
    try {
      value = node.as<double>();
    } catch (const YAML::Exception&) {
      value = NAN;
    }
  }
  value = std::round(1e3 * value) / 1e3;
  if (!std::isfinite(value)) refuse_place(corner, file, "a corner must be [x, y] or {x: …, y: …}, in metres");
  return value;
}

Polygon polygon_in(const YAML::Node& node, const std::string& file, const std::string& key) {
  if (!node.IsSequence() || node.size() < 3) refuse_place(node, file, "'" + key + "' needs at least three corners");
  Polygon polygon;
  for (const YAML::Node& corner : node) {
    const bool is_pair = corner.IsSequence() && corner.size() == 2;
    const bool is_named = corner.IsMap() && corner.size() == 2;
    if (!is_pair && !is_named) refuse_place(corner, file, "a corner must be [x, y] or {x: …, y: …}, in metres");
    polygon.emplace_back(coordinate_in(is_pair ? corner[0] : corner["x"], corner, file),
                         coordinate_in(is_pair ? corner[1] : corner["y"], corner, file));
  }
  return without_repeated_corners(std::move(polygon));
}

ListedPlace place_in(const YAML::Node& node, const std::string& file, const PlaceKeys& keys) {
  if (!node.IsMap()) refuse_place(node, file, "an entry of '" + keys.list + "' must hold keys and values");
  ListedPlace place{.id = "", .polygon = {}, .line = node.Mark().line + 1};
  std::set<std::string> seen;
  for (const auto& entry : node) {
    const std::string key = entry.first.IsScalar() ? entry.first.Scalar() : "";
    if (!seen.insert(key).second) refuse_place(entry.first, file, "'" + key + "' stands twice");
    if (key == keys.id) {
      place.id = word_in(entry.second, file, key);
    } else if (key == keys.polygon) {
      place.polygon = polygon_in(entry.second, file, key);
    } else if (std::find(keys.words.begin(), keys.words.end(), key) != keys.words.end()) {
      place.words[key] = word_in(entry.second, file, key);
    } else {
      refuse_place(entry.first, file, "nothing is called '" + key + "' here");
    }
  }
  for (const std::string& needed : {keys.id, keys.polygon}) {
    if (!seen.contains(needed)) refuse_place(node, file, "'" + needed + "' is missing");
  }
  return place;
}

bool stands_as_it_is(char32_t code) {
  const bool is_control = code < 0x20 || (code >= 0x7F && code <= 0xA0);
  const bool is_noncharacter = (code & 0xFFFEu) == 0xFFFE || (code >= 0xFDD0 && code <= 0xFDEF);
  return !is_control && !is_noncharacter && !unusual_blank(code) && code != U'"' && code != U'\\';
}

/// Any text, on one line. The library's own writer puts U+FFFD in the place of some characters (U+FFFF): an id that is
/// written so is not the one that was asked for.
std::string in_quotes(std::string_view text) {
  std::string written = "\"";
  for (std::size_t at = 0; at < text.size();) {
    const auto character = character_at(text, at);
    if (!character) throw std::runtime_error("a character that is not UTF-8 cannot be written");
    if (stands_as_it_is(character->code)) {
      written += text.substr(at, character->bytes);
    } else {
      char escape[16];
      (void)std::snprintf(escape, sizeof escape, "\\U%08X", static_cast<unsigned>(character->code));
      written += escape;
    }
    at += character->bytes;
  }
  return written + "\"";
}

}  // namespace

std::string in_mm(double length_m) { return yaml_number(std::round(1e3 * length_m) / 1e3 + 0.0); }

void require_text(std::string_view text, const std::string& file) {
  if (const auto binary = binary_byte(text))
    throw std::runtime_error(file + ": line " + std::to_string(binary->line) + ": " + binary->what);
  int line = 1;
  for (std::size_t at = 0; at < text.size();) {
    const auto character = character_at(text, at);
    if (!character) {
      throw std::runtime_error(file + ": line " + std::to_string(line) +
                               ": a character that is not UTF-8: write the file in UTF-8");
    }
    line += character->code == U'\n' ? 1 : 0;
    at += character->bytes;
  }
}

Polygon without_repeated_corners(Polygon polygon) {
  polygon.erase(std::unique(polygon.begin(), polygon.end()), polygon.end());
  if (polygon.size() > 1 && polygon.back() == polygon.front()) polygon.pop_back();
  return polygon;
}

std::vector<ListedPlace> places_in(std::string_view yaml, const std::string& file, const PlaceKeys& keys) {
  require_text(yaml, file);
  YAML::Node root;
  try {
    root = only_yaml_tree(std::string(yaml));
  } catch (const YAML::Exception& error) {
    throw std::runtime_error(file + ": " + placed_meaning_of(error, std::string(yaml)));
  }
  const std::string wanted = "must hold '" + keys.list + ":' and a list, and nothing else";
  const auto expected = [&] { refuse_place(root, file, wanted); };
  if (root.IsNull()) throw std::runtime_error(file + ": holds nothing yet: it " + wanted);
  if (!root.IsMap() || root.size() != 1 || !root[keys.list]) expected();
  const YAML::Node list = root[keys.list];
  if (list.IsNull()) return {};
  if (!list.IsSequence()) expected();
  std::vector<ListedPlace> places;
  for (const YAML::Node& node : list) places.push_back(place_in(node, file, keys));
  return places;
}

std::string places_as_yaml(const std::vector<ListedPlace>& places, const PlaceKeys& keys) {
  std::string yaml = keys.list + ":\n";
  for (const ListedPlace& place : places) {
    yaml += "  - " + keys.id + ": " + in_quotes(place.id) + "\n";
    for (const std::string& key : keys.words) {
      const auto word = place.words.find(key);
      if (word == place.words.end()) continue;
      const bool is_number = std::find(keys.numbers.begin(), keys.numbers.end(), key) != keys.numbers.end();
      yaml += "    " + key + ": " + (is_number ? word->second : in_quotes(word->second)) + "\n";
    }
    yaml += "    " + keys.polygon + ": [";
    for (const Point2& corner : place.polygon) {
      yaml += &corner == &place.polygon.front() ? "[" : ", [";
      yaml += in_mm(corner.x()) + ", " + in_mm(corner.y()) + "]";
    }
    yaml += "]\n";
  }
  return yaml;
}

}  // namespace deltamap::daemon
