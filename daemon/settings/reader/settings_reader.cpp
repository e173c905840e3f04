// SPDX-License-Identifier: Apache-2.0
#include "daemon/settings/reader/settings_reader.hpp"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <array>
#include <optional>
#include <sstream>
#include <string_view>
#include <utility>

#include "core/files/yaml_tree.hpp"
#include "daemon/settings/reader/nearest_key.hpp"
#include "daemon/settings/reader/yaml_text.hpp"

namespace deltamap::daemon {
namespace {

constexpr std::size_t kLongestQuote = 40;  // of what was found, in a mistake
constexpr std::size_t kLongestName = 100;

std::string shortened(const std::string& text, std::size_t longest) {
  return text.size() <= longest ? text : text.substr(0, longest) + "...";
}

std::string quoted(const std::string& text) { return "'" + shortened(text, kLongestQuote) + "'"; }

/// Walks YAML trees of one file or override and hands every leaf to its key.
class Walk {
 public:
  Walk(const std::vector<SettingKey>& keys, const std::map<std::string, std::string>& former, SettingPlace source,
       SettingsProblems& problems, ReadKeys& read)
      : keys_{keys},
        former_{former},
        sections_{sections_of(keys)},
        source_{std::move(source)},
        problems_{problems},
        read_{read} {}

  /// Sets the line of the file, counted from 0, at which the YAML that is read next begins.
  void go_to_line(std::size_t line) { first_line_ = static_cast<int>(line); }

  /// `key` is the node that names `node`.
  void read(const std::string& path, const YAML::Node& node, const YAML::Node& key) {
    if (has_enough()) return;
    const auto known = std::find_if(keys_.begin(), keys_.end(), [&](const SettingKey& k) { return k.name == path; });
    if (known != keys_.end()) return assign(*known, node, key);
    if (!path.empty() && !is_section(path)) return add_unknown(path, key, node.IsMap());
    if (node.IsNull()) return;  // an empty section
    if (!node.IsMap()) return add(path, node, key, must_hold_keys(path, node));
    for (const auto& entry : node) read_entry(path, entry.first, entry.second);
  }

  /// The section that this line opens, when the lines below are read on their own; empty where it is given twice,
  /// nullopt where the line opens none.
  [[nodiscard]] std::optional<std::string> enter(const std::string& path, const YAML::Node& line) {
    const auto entry = line.begin();
    if (!line.IsMap() || line.size() != 1 || !entry->second.IsNull() || !entry->first.IsScalar()) return std::nullopt;
    std::string child = below(path, entry->first.Scalar());
    if (!is_section(child)) return std::nullopt;
    if (!is_new(child, entry->first)) return "";
    return child;
  }

  /// True once more mistakes are found than are told; then the rest is not read.
  [[nodiscard]] bool has_enough() {
    if (told_ <= SettingsProblems::kMostTold) return false;
    read_.is_whole = false;
    return true;
  }

  void add_text_problem(int line, int column, std::string what) {
    SettingPlace place = source_;
    if (place.source == 0) {
      place.line = line + first_line_;
      place.column = column;
    }
    problems_.add(std::move(place), std::move(what));
    read_.is_whole = false;
  }

 private:
  static std::string below(const std::string& path, const std::string& name) {
    return path.empty() ? name : path + "." + name;
  }
  [[nodiscard]] bool is_section(const std::string& path) const {
    const auto holds = [&](const auto& former) { return former.first.starts_with(path + "."); };
    return std::find(sections_.begin(), sections_.end(), path) != sections_.end() ||
           std::any_of(former_.begin(), former_.end(), holds);
  }

  void read_entry(const std::string& path, const YAML::Node& key, const YAML::Node& node) {
    if (!key.IsScalar()) return add(path, key, key, "a key must be a word");
    const std::string child = below(path, key.Scalar());
    if (is_new(child, key)) read(child, node, key);
  }

  /// False, and a mistake, where the key was given before, be it nested or dotted.
  bool is_new(const std::string& path, const YAML::Node& key) {
    const int line = place_of(key, key).line;
    const auto [first, is_new] = lines_.emplace(path, line);
    if (!is_new) add(path, key, key, "given twice, first in line " + std::to_string(first->second));
    return is_new;
  }

  static std::string must_hold_keys(const std::string& path, const YAML::Node& node) {
    std::string line = path.empty() ? "the file must hold keys" : "must hold keys";
    if (!node.IsScalar()) return line + ", not a list";
    const std::string& found = node.Scalar();
    return line + ", not " + quoted(found) + hint_of(found);
  }

  /// A hint about the likely slip in a line without "key: value".
  static std::string hint_of(const std::string& words) {
    if (words.find('=') < words.find(':')) return ": 'key=value' is for --set, the file has 'key: value'";
    return words.find(':') == std::string::npos ? "" : ": a blank belongs behind the colon";
  }

  void assign(const SettingKey& key, const YAML::Node& node, const YAML::Node& named) {
    if (node.IsMap()) return add(key.name, node, named, "takes one value, not keys");
    SettingValue value;
    if (node.IsScalar()) value = {SettingValue::Kind::kScalar, {node.Scalar()}, node.Tag() == "!"};
    if (node.IsSequence()) {
      value.kind = SettingValue::Kind::kList;
      for (const auto& item : node) {
        const bool is_pair = key.type == SettingKey::Type::kBearings && item.IsSequence() && item.size() == 2 &&
                             item[0].IsScalar() && item[1].IsScalar();
        if (!item.IsScalar() && !is_pair) return add(key.name, node, named, "takes no nested lists");
        value.items.push_back(is_pair ? item[0].Scalar() + " " + item[1].Scalar() : item.Scalar());
      }
    }
    read_.places[key.name] = place_of(node, named);
    if (const auto needed = key.assign(value))
      add(key.name, node, named, "needs " + *needed + ", not " + found(key, value));
  }

  /// The value that the file gives, in words for the mistake "needs …, not …".
  static std::string found(const SettingKey& key, const SettingValue& value) {
    using Type = SettingKey::Type;
    if (value.kind == SettingValue::Kind::kNull) return "nothing";
    if (value.kind == SettingValue::Kind::kList) {
      if (key.type != Type::kPose) return "a list";
      if (value.items.size() != 3) return "a list of " + std::to_string(value.items.size());
      return quoted("[" + value.items[0] + ", " + value.items[1] + ", " + value.items[2] + "]");
    }
    const bool quotes_matter = value.quoted && key.type != Type::kText && key.type != Type::kWord;
    return quoted(value.items.front()) + (quotes_matter ? " in quotes" : "");
  }

  void add_unknown(const std::string& path, const YAML::Node& key, bool has_keys_below) {
    if (const auto former = former_.find(path); former != former_.end()) {
      const std::string& new_name = former->second;
      return tell(place_of(key, key), path,
                  new_name.empty() ? "no longer a setting: its value is fixed, remove the line"
                                   : "is now called " + quoted(new_name));
    }
    const UnknownKey unknown = unknown_key(keys_, path, has_keys_below);
    for (const std::string& meant : unknown.meant) doubt(meant);
    tell(place_of(key, key), path, unknown.rule + hint_of(path));
  }

  void add(const std::string& path, const YAML::Node& node, const YAML::Node& key, const std::string& what) {
    doubt(path);
    tell(place_of(node, key), path, what);
  }

  void tell(SettingPlace place, const std::string& path, const std::string& what) {
    ++told_;
    problems_.add(std::move(place), (path.empty() ? "" : shortened(path, kLongestName) + ": ") + what);
  }

  /// Notes the key, or all keys of the section, as doubtful: their intended values are not known.
  void doubt(const std::string& path) {
    for (const SettingKey& key : keys_) {
      if (key.name == path || path.empty() || key.name.starts_with(path + ".")) read_.doubtful.insert(key.name);
    }
  }

  /// The place of a value; an empty value has none of its own and takes that of its key.
  [[nodiscard]] SettingPlace place_of(const YAML::Node& node, const YAML::Node& key) const {
    const YAML::Mark mark = node.IsNull() ? key.Mark() : node.Mark();
    SettingPlace place = source_;
    if (place.source != 0) return place;
    place.line = mark.is_null() ? first_line_ + 1 : first_line_ + mark.line + 1;
    place.column = mark.is_null() ? 1 : mark.column + 1;
    return place;
  }

  const std::vector<SettingKey>& keys_;
  const std::map<std::string, std::string>& former_;
  std::vector<std::string> sections_;
  SettingPlace source_;
  SettingsProblems& problems_;
  ReadKeys& read_;
  std::map<std::string, int> lines_;  // of every key and section that was given
  int first_line_ = 0;
  std::size_t told_ = 0;
};

/// Reads as much as there is to be read: where lines cannot be read together, each part of them alone.
class PartReader {
 public:
  PartReader(const std::vector<YamlLine>& lines, Walk& walk) : lines_{lines}, walk_{walk} {}

  /// The lines from `first` up to `last`, which stand below the section `path`.
  void read(const std::string& path, std::size_t first, std::size_t last) {
    if (walk_.has_enough()) return;
    const auto error = read_together(path, first, last);
    if (!error) return;
    const auto parts = parts_of(lines_, first, last);
    const bool is_uneven = parts.size() > 1 && lines_[parts[0].first].indentation != lines_[parts[1].first].indentation;
    if (parts.size() > 1) {
      for (const LineRange& part : parts) read(path, part.first, part.last);
    }
    if (is_uneven || parts.empty() || (parts.size() == 1 && !read_below(path, parts.front()))) {
      add(*error, first, last);
    }
  }

 private:
  /// What is missing at the end is missing behind the last line that says something.
  void add(const YAML::Exception& error, std::size_t first, std::size_t last) {
    std::size_t end = last;
    while (end > first + 1 && !lines_[end - 1].has_content) --end;
    const std::size_t line = first + static_cast<std::size_t>(std::max(error.mark.line, 0));
    const bool is_behind = line >= end;
    walk_.go_to_line(is_behind ? end - 1 : line);
    const int column = is_behind ? static_cast<int>(lines_[end - 1].text.size()) : error.mark.column;
    walk_.add_text_problem(1, column + 1, meaning_of(error));
  }

  std::optional<YAML::Exception> read_together(const std::string& path, std::size_t first, std::size_t last) {
    try {
      const YAML::Node tree = only_yaml_tree(text_of(lines_, first, last));
      walk_.go_to_line(first);
      walk_.read(path, tree, tree);
      return std::nullopt;
    } catch (const YAML::Exception& error) {
      return error;
    }
  }

  /// A section line, and then what stands below it. False: it is none.
  bool read_below(const std::string& path, const LineRange& part) {
    const std::size_t below = part.first + 1;
    if (below >= part.last || parts_of(lines_, below, part.last).empty()) return false;
    try {
      walk_.go_to_line(part.first);
      const auto section = walk_.enter(path, YAML::Load(text_of(lines_, part.first, below)));
      if (section && !section->empty()) read(*section, below, part.last);
      return section.has_value();
    } catch (const YAML::Exception&) {
      return false;
    }
  }

  const std::vector<YamlLine>& lines_;
  Walk& walk_;
};

}  // namespace

void SettingsReader::read_file(const std::string& yaml, const std::string& name) {
  file_ = name;
  Walk walk{keys_, former_, {.name = name}, problems_, read_};
  const YamlText text = yaml_text(yaml);
  for (const TextProblem& one : text.problems) walk.add_text_problem(one.line, one.column, one.what);
  PartReader{text.lines, walk}.read("", 0, text.lines.size());
}

void SettingsReader::read_override(const std::string& text) {
  const SettingPlace place{.name = "--set " + text, .source = ++overrides_};
  const auto equals = text.find('=');
  if (equals == std::string::npos || equals == 0) return problems_.add(place, "give key=value");
  const std::string value = text.substr(equals + 1);
  Walk walk{keys_, former_, place, problems_, read_};
  // On a command line "key=" means empty text, not "nothing".
  const YamlText checked = yaml_text(value.empty() ? "\"\"" : value);
  for (const TextProblem& one : checked.problems) walk.add_text_problem(1, 1, one.what);
  if (!checked.problems.empty()) return;
  try {
    const YAML::Node tree = only_yaml_tree(text_of(checked.lines, 0, checked.lines.size()));
    walk.read(text.substr(0, equals), tree, tree);
  } catch (const YAML::Exception& error) {
    walk.add_text_problem(1, 1, meaning_of(error));
  }
}

void SettingsReader::add_contradiction(const std::string& key, const std::string& rule,
                                       const std::vector<std::string>& others) {
  std::vector<std::string> concerned{key};
  concerned.insert(concerned.end(), others.begin(), others.end());
  const auto is_doubtful = [&](const std::string& one) { return read_.doubtful.contains(one); };
  if (std::any_of(concerned.begin(), concerned.end(), is_doubtful)) return;
  // What could not be read may say otherwise, but not of keys that are given elsewhere.
  const auto is_given = [&](const std::string& one) { return read_.places.contains(one); };
  if (!read_.is_whole && !std::all_of(concerned.begin(), concerned.end(), is_given)) return;
  const auto given = std::find_if(concerned.begin(), concerned.end(),
                                  [&](const std::string& one) { return read_.places.contains(one); });
  SettingPlace place{.name = file_};
  if (given != concerned.end()) place = read_.places.at(*given);
  problems_.add(std::move(place), key + ": " + rule);
}

}  // namespace deltamap::daemon
