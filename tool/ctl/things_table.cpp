// SPDX-License-Identifier: Apache-2.0
#include "tool/ctl/things_table.hpp"

#include <cstdio>
#include <nlohmann/json.hpp>

#include "core/counted.hpp"
#include "core/utc_text.hpp"

namespace deltamap::tool {
namespace {

using ThingsJson = nlohmann::ordered_json;

/// To the second: "2026-11-23T00:40:10Z"
std::string instant_of(const ThingsJson& unix_s) {
  return utc_text(timestamp_from_ns(static_cast<std::int64_t>(unix_s.get<double>() * 1e9))).substr(0, 19) + "Z";
}

std::string row_of(const ThingsJson& thing) {
  char head[128];
  (void)std::snprintf(head, sizeof head, "%5u  %-20s  %-20s  %4.2f  ", thing.at("thing").get<unsigned>(),
                      instant_of(thing.at("first_seen")).c_str(), instant_of(thing.at("last_seen")).c_str(),
                      thing.at("confidence").get<double>());
  return head + thing.at("words").get<std::string>() + "\n";
}

}  // namespace

std::string things_table(const std::string& list_line) {
  const auto list = ThingsJson::parse(list_line);
  std::string text;
  if (!list.at("things").empty()) text = "thing  first seen            last seen             conf  what\n";
  for (const ThingsJson& thing : list.at("things")) text += row_of(thing);
  text += counted(list.at("things").size(), "thing") + "; " +
          counted(list.at("corrections").get<std::uint64_t>(), "changed cell belongs to none",
                  "changed cells belong to none");
  const auto forgotten = list.at("forgotten").get<std::uint64_t>();
  return text +
         (forgotten == 0 ? "\n" : "; " + counted(forgotten, "older thing is", "older things are") + " not listed\n");
}

}  // namespace deltamap::tool
