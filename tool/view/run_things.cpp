// SPDX-License-Identifier: Apache-2.0
#include "tool/view/run_things.hpp"

#include <map>
#include <nlohmann/json.hpp>
#include <system_error>

namespace deltamap::tool {
namespace {

using ThingLine = nlohmann::ordered_json;

bool is_thing_line(const ThingLine& line) {
  return line.is_object() && line.contains("time") && line["time"].is_number() && line.contains("thing") &&
         line["thing"].is_number_unsigned();
}

}  // namespace

void RunThings::read_on(std::ifstream& in) {
  std::error_code error;
  if (const auto size = std::filesystem::file_size(file_, error); !error && size < read_to_) {
    lines_.clear();
    unread_ = 0;
    read_to_ = 0;
  }
  in.seekg(static_cast<std::streamoff>(read_to_));
  for (std::string text; std::getline(in, text) && !in.eof(); read_to_ += text.size() + 1) {
    const ThingLine line = ThingLine::parse(text, nullptr, false);
    if (is_thing_line(line)) {
      lines_.push_back({line["time"].get<double>(), line["thing"].get<std::uint32_t>(), read_to_});
    } else {
      ++unread_;
    }
  }
  in.clear();
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
    std::string text;
    in.seekg(static_cast<std::streamoff>(begins));
    std::getline(in, text);
    ThingLine line = ThingLine::parse(text, nullptr, false);
    if (is_thing_line(line)) answer["things"].push_back(std::move(line));  // else it was rewritten meanwhile
  }
  return answer.dump();
}

}  // namespace deltamap::tool
