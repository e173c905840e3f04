// SPDX-License-Identifier: Apache-2.0
#include "tool/ctl/bays_table.hpp"

#include <cstdio>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "core/counted.hpp"
#include "core/utc_text.hpp"

namespace deltamap::tool {
namespace {

using BaysJson = nlohmann::ordered_json;

/// "40 s", "12 min", "3 h", "5 d"
std::string age_of(const BaysJson& age_s) {
  if (age_s.is_null()) return "never";
  const double age = age_s.get<double>();
  char text[32];
  if (age < 100.0) {
    (void)std::snprintf(text, sizeof text, "%.0f s", age);
  } else if (age < 6000.0) {
    (void)std::snprintf(text, sizeof text, "%.0f min", age / 60.0);
  } else if (age < 172'800.0) {
    (void)std::snprintf(text, sizeof text, "%.0f h", age / 3600.0);
  } else {
    (void)std::snprintf(text, sizeof text, "%.0f d", age / 86'400.0);
  }
  return text;
}

std::string since_of(const BaysJson& unix_s) {
  if (unix_s.is_null()) return "-";
  return utc_text(timestamp_from_ns(static_cast<std::int64_t>(unix_s.get<double>() * 1e9))).substr(0, 19) + "Z";
}

std::string bay_row(const BaysJson& bay) {
  char share[8] = "-";
  if (!bay.at("share").is_null()) (void)std::snprintf(share, sizeof share, "%.2f", bay.at("share").get<double>());
  char head[160];
  (void)std::snprintf(head, sizeof head, "%-12s  %-8s  %5s  %4.2f  %8s  %-20s  ",
                      bay.at("bay").get<std::string>().c_str(), bay.at("state").get<std::string>().c_str(), share,
                      bay.at("confidence").get<double>(), age_of(bay.at("age_s")).c_str(),
                      since_of(bay.at("since")).c_str());
  std::string row = head + bay.value("name", "");
  for (const BaysJson& thing : bay.at("things")) row += (row.back() == ' ' ? "thing " : ", thing ") + thing.dump();
  row.erase(row.find_last_not_of(' ') + 1);
  return row + "\n";
}

}  // namespace

std::string bays_table(const std::string& list_line) {
  const auto list = BaysJson::parse(list_line);
  std::string text;
  if (list.at("bays").empty()) return "no bay: the file that 'bays.file' of the settings names lists them\n";
  text = "bay           state     share  conf      seen  since                 what\n";
  std::map<std::string, std::size_t> states;
  for (const BaysJson& bay : list.at("bays")) {
    text += bay_row(bay);
    ++states[bay.at("state").get<std::string>()];
  }
  text += counted(list.at("bays").size(), "bay");
  const char* before = ": ";
  for (const char* state : {"full", "partly", "empty", "unknown"}) {
    if (states[state] == 0) continue;
    text += before + std::to_string(states[state]) + " " + state;
    before = ", ";
  }
  return text + "\n";
}

std::string bay_lines(const std::string& json_lines) {
  std::istringstream lines{json_lines};
  std::string text;
  for (std::string line; std::getline(lines, line);) {
    const auto told = BaysJson::parse(line);
    char words[160];
    (void)std::snprintf(words, sizeof words, "%s  %-12s  %-8s  was %s", since_of(told.at("time")).c_str(),
                        told.at("bay").get<std::string>().c_str(), told.at("state").get<std::string>().c_str(),
                        told.at("before").get<std::string>().c_str());
    text += words;
    if (const BaysJson& share = told.at("share"); !share.is_null()) {
      (void)std::snprintf(words, sizeof words, "; %.2f of its floor is taken", share.get<double>());
      text += words;
    }
    text += "\n";
  }
  return text;
}

}  // namespace deltamap::tool
