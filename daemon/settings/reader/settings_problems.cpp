// SPDX-License-Identifier: Apache-2.0
#include "daemon/settings/reader/settings_problems.hpp"

#include <algorithm>
#include <tuple>
#include <utility>

namespace deltamap::daemon {
namespace {

std::string text_of(const SettingPlace& place) {
  if (place.line == 0) return place.name;
  return place.name + ":" + std::to_string(place.line) + ":" + std::to_string(place.column);
}

bool is_control(char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7F; }

}  // namespace

void SettingsProblems::add(SettingPlace place, std::string what) {
  problems_.push_back({std::move(place), std::move(what)});
}

std::vector<std::string> SettingsProblems::lines() const {
  std::vector<Problem> sorted = problems_;
  std::stable_sort(sorted.begin(), sorted.end(), [](const Problem& a, const Problem& b) {
    return std::tie(a.place.source, a.place.line, a.place.column) <
           std::tie(b.place.source, b.place.line, b.place.column);
  });
  std::vector<std::string> lines;
  for (const Problem& one : sorted) {
    const bool is_enough = lines.size() == kMostTold;
    lines.push_back(text_of(one.place) + ": " + (is_enough ? "more mistakes follow" : one.what));
    std::replace_if(lines.back().begin(), lines.back().end(), is_control, ' ');
    if (is_enough) break;
  }
  return lines;
}

}  // namespace deltamap::daemon
