// SPDX-License-Identifier: Apache-2.0
// An instant as people and other programs read it.
#pragma once

#include <cstdint>
#include <cstdio>
#include <ctime>
#include <string>

#include "core/time.hpp"

namespace deltamap {

/// "2026-11-23T00:40:10.123Z"
[[nodiscard]] inline std::string utc_text(Timestamp time) {
  const std::int64_t ms = unix_ns(time) / 1'000'000;
  const auto whole_s = static_cast<std::time_t>(ms / 1000);
  std::tm calendar{};
  (void)gmtime_r(&whole_s, &calendar);
  char day[32];
  char text[48];
  (void)std::strftime(day, sizeof day, "%Y-%m-%dT%H:%M:%S", &calendar);
  (void)std::snprintf(text, sizeof text, "%s.%03dZ", day, static_cast<int>(ms % 1000));
  return text;
}

/// "20261123T004010Z", for names of files.
[[nodiscard]] inline std::string utc_name(Timestamp time) {
  std::string name;
  for (const char c : utc_text(time).substr(0, 19)) {
    if (c != '-' && c != ':') name += c;
  }
  return name + "Z";
}

}  // namespace deltamap
