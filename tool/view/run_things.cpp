// SPDX-License-Identifier: Apache-2.0
#include "tool/view/run_things.hpp"

#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

namespace deltamap::tool {
namespace {

using ThingLine = nlohmann::ordered_json;

bool is_thing_line(const ThingLine& line) {
  return line.is_object() && line.contains("time") && line["time"].is_number() && line.contains("thing") &&
         line["thing"].is_number_unsigned();
}

}  // namespace

std::string things_at(const std::filesystem::path& things_jsonl, Timestamp time) {
  std::map<std::uint32_t, ThingLine> newest;
  std::size_t unread = 0;
  std::ifstream in(things_jsonl);
  for (std::string text; std::getline(in, text) && !in.eof();) {
    ThingLine line = ThingLine::parse(text, nullptr, false);
    if (!is_thing_line(line)) {
      ++unread;
    } else if (line["time"].get<double>() <= unix_seconds(time)) {
      const auto thing = line["thing"].get<std::uint32_t>();
      newest.insert_or_assign(thing, std::move(line));
    }
  }
  ThingLine answer{{"ok", true}, {"things", ThingLine::array()}, {"unread", unread}};
  for (auto& [id, line] : newest) answer["things"].push_back(std::move(line));
  return answer.dump();
}

}  // namespace deltamap::tool
