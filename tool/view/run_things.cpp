// SPDX-License-Identifier: Apache-2.0
#include "tool/view/run_things.hpp"

#include <map>
#include <nlohmann/json.hpp>
#include <utility>

namespace deltamap::tool {
namespace {

using ThingLine = nlohmann::ordered_json;

bool is_thing_line(const ThingLine& line) {
  return line.is_object() && line.contains("time") && line["time"].is_number() && line.contains("thing") &&
         line["thing"].is_number_unsigned();
}

}  // namespace

std::string RunThings::line_at(std::ifstream& in, std::uint64_t begins) {
  std::string text;
  in.clear();
  in.seekg(static_cast<std::streamoff>(begins));
  std::getline(in, text);
  return text;
}

/// A run that is replayed into the same folder begins its file anew.
bool RunThings::goes_on(std::ifstream& in) const {
  if (read_to_ == 0) return true;
  if (line_at(in, 0) != first_) return false;
  in.clear();
  in.seekg(static_cast<std::streamoff>(read_to_ - 1));
  return in.get() == '\n';
}

void RunThings::read_on(std::ifstream& in) {
  if (!goes_on(in)) {
    lines_.clear();
    unread_ = 0;
    read_to_ = 0;
  }
  in.clear();
  in.seekg(static_cast<std::streamoff>(read_to_));
  for (std::string text; std::getline(in, text) && !in.eof(); read_to_ += text.size() + 1) {
    if (read_to_ == 0) first_ = text;
    const ThingLine line = ThingLine::parse(text, nullptr, false);
    if (is_thing_line(line)) {
      lines_.push_back({line["time"].get<double>(), line["thing"].get<std::uint32_t>(), read_to_});
    } else {
      ++unread_;
    }
  }
}

std::string RunThings::at(Timestamp time) {
  std::ifstream in(file_, std::ios::binary);
  if (in) read_on(in);
  std::map<std::uint32_t, std::uint64_t> newest;
  for (const Line& line : lines_) {
    if (line.time_s <= unix_seconds(time)) newest[line.thing] = line.begins;
  }
  ThingLine answer{{"ok", true}, {"things", ThingLine::array()}, {"unread", unread_}};
  for (const auto& [thing, begins] : newest) {
    ThingLine line = ThingLine::parse(line_at(in, begins), nullptr, false);
    if (is_thing_line(line)) answer["things"].push_back(std::move(line));  // else it was rewritten meanwhile
  }
  return answer.dump();
}

}  // namespace deltamap::tool
