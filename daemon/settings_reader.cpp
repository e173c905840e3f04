// SPDX-License-Identifier: Apache-2.0
#include "daemon/settings_reader.hpp"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include "daemon/nearest_key.hpp"
#include "daemon/yaml_text.hpp"

namespace deltamap::daemon {
namespace {

/// The YAML reader's words, and what they mean to whoever wrote the file.
constexpr std::array<std::pair<std::string_view, std::string_view>, 6> kMeanings{{
    {"illegal map value", "a ':' is out of place: look at the indentation, or put the value into quotes"},
    {"end of map not found", "the indentation does not fit the lines above"},
    {"end of sequence not found", "the indentation does not fit the lines above"},
    {"end of map flow not found", "a '{' is not closed"},
    {"end of sequence flow not found", "a '[' is not closed"},
    {"unknown escape character", "a backslash in double quotes: write it twice, or use single quotes"},
}};

std::string meaning_of(const std::string& message) {
  const auto* known =
      std::find_if(kMeanings.begin(), kMeanings.end(), [&](const auto& one) { return message.starts_with(one.first); });
  return known == kMeanings.end() ? message : std::string(known->second);
}

constexpr std::size_t kMostMistakes = 50;  // that are told: a file with more is another kind of file
constexpr std::size_t kLongestQuote = 40;  // of what was found, in a mistake

std::string quoted(const std::string& text) {
  return "'" + (text.size() <= kLongestQuote ? text : text.substr(0, kLongestQuote) + "...") + "'";
}

/// Names places in one text.
struct Place {
  std::string name;
  bool is_file;

  [[nodiscard]] std::string at(int line, int column) const {
    if (!is_file) return name;
    return name + ":" + std::to_string(line) + ":" + std::to_string(column);
  }
  /// What has no place of its own (an empty value) stands where its key does.
  [[nodiscard]] std::string of(const YAML::Node& node, const YAML::Node& key) const {
    const YAML::Mark mark = node.IsNull() ? key.Mark() : node.Mark();
    return at(mark.is_null() ? 1 : mark.line + 1, mark.is_null() ? 1 : mark.column + 1);
  }
};

/// Walks a YAML tree and hands every leaf to its key.
class Walk {
 public:
  Walk(const std::vector<SettingKey>& keys, Place place, std::vector<std::string>& problems,
       std::map<std::string, std::string>& places)
      : keys_{keys}, sections_{sections_of(keys)}, place_{std::move(place)}, problems_{problems}, places_{places} {}

  /// `key` is the node that names `node`.
  void read(const std::string& path, const YAML::Node& node, const YAML::Node& key) {
    if (problems_.size() == kMostMistakes) problems_.push_back(place_.of(key, key) + ": more mistakes follow");
    if (problems_.size() > kMostMistakes) return;
    const auto known = std::find_if(keys_.begin(), keys_.end(), [&](const SettingKey& k) { return k.name == path; });
    if (known != keys_.end()) return assign(*known, node, key);
    if (!path.empty() && !is_section(path)) return add(key, key, unknown_key_line(keys_, path, node.IsMap()));
    if (node.IsNull()) return;  // an empty section
    if (!node.IsMap()) return add(node, key, must_hold_keys(path, node));
    read_entries(path, node);
  }

 private:
  [[nodiscard]] bool is_section(const std::string& path) const {
    return std::find(sections_.begin(), sections_.end(), path) != sections_.end();
  }

  void read_entries(const std::string& path, const YAML::Node& node) {
    std::map<std::string, int> lines;
    for (const auto& entry : node) {
      if (!entry.first.IsScalar()) {
        add(entry.first, entry.first, "a key must be a word");
        continue;
      }
      const std::string child = path.empty() ? entry.first.Scalar() : path + "." + entry.first.Scalar();
      const auto [first, is_new] = lines.emplace(child, entry.first.Mark().line + 1);
      if (is_new) {
        read(child, entry.second, entry.first);
      } else {
        add(entry.first, entry.first, "'" + child + "' is given twice, first in line " + std::to_string(first->second));
      }
    }
  }

  static std::string must_hold_keys(const std::string& path, const YAML::Node& node) {
    std::string line = (path.empty() ? "the file" : "'" + path + "'") + " must hold keys";
    if (!node.IsScalar()) return line + ", not a list";
    line += ", not " + quoted(node.Scalar());
    return node.Scalar().find(':') == std::string::npos ? line : line + ": a blank belongs behind the colon";
  }

  void assign(const SettingKey& key, const YAML::Node& node, const YAML::Node& named) {
    if (node.IsMap()) return add(node, named, "'" + key.name + "' takes one value, not keys");
    SettingValue value;
    if (node.IsScalar()) value = {SettingValue::Kind::kScalar, {node.Scalar()}, node.Tag() == "!"};
    if (node.IsSequence()) {
      value.kind = SettingValue::Kind::kList;
      for (const auto& item : node) {
        if (!item.IsScalar()) return add(node, named, "'" + key.name + "' takes no nested lists");
        value.items.push_back(item.Scalar());
      }
    }
    places_[key.name] = place_.of(node, named);
    if (const auto needed = key.assign(value)) {
      const std::string found = node.IsScalar() ? quoted(node.Scalar()) : node.IsNull() ? "nothing" : "a list";
      add(node, named, "'" + key.name + "' needs " + *needed + ", not " + found);
    }
  }

  void add(const YAML::Node& node, const YAML::Node& key, const std::string& what) {
    problems_.push_back(place_.of(node, key) + ": " + what);
  }

  const std::vector<SettingKey>& keys_;
  std::vector<std::string> sections_;
  Place place_;
  std::vector<std::string>& problems_;
  std::map<std::string, std::string>& places_;
};

/// What is wrong with the text itself; else the tree.
std::pair<YAML::Node, std::vector<std::string>> loaded(const std::string& yaml, const Place& place) {
  std::vector<std::string> problems;
  for (const TextProblem& one : problems_of_text(yaml)) {
    problems.push_back(place.at(one.line, one.column) + ": " + one.what);
  }
  if (!problems.empty()) return {{}, problems};
  try {
    return {YAML::Load(yaml), {}};
  } catch (const YAML::Exception& error) {
    return {{}, {place.at(error.mark.line + 1, error.mark.column + 1) + ": not YAML: " + meaning_of(error.msg)}};
  }
}

}  // namespace

void SettingsReader::read_file(const std::string& yaml, const std::string& name) {
  const Place place{name, true};
  const auto [tree, problems] = loaded(yaml, place);
  problems_.insert(problems_.end(), problems.begin(), problems.end());
  if (problems.empty()) Walk{keys_, place, problems_, places_}.read("", tree, tree);
}

void SettingsReader::read_override(const std::string& text) {
  const Place place{"--set " + text, false};
  const auto equals = text.find('=');
  if (equals == std::string::npos || equals == 0) {
    problems_.push_back(place.name + ": give key=value");
    return;
  }
  const std::string value = text.substr(equals + 1);
  // On a command line "key=" means empty text, not "nothing".
  const auto [tree, problems] = loaded(value.empty() ? "\"\"" : value, place);
  problems_.insert(problems_.end(), problems.begin(), problems.end());
  if (problems.empty()) Walk{keys_, place, problems_, places_}.read(text.substr(0, equals), tree, tree);
}

std::string SettingsReader::place_of(const std::string& key, const std::string& otherwise) const {
  const auto found = places_.find(key);
  return found == places_.end() ? otherwise : found->second;
}

}  // namespace deltamap::daemon
