// SPDX-License-Identifier: Apache-2.0
#include "daemon/telemetry/log_throttle.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace deltamap::daemon {
namespace {

constexpr std::chrono::minutes kPeriod{1};
constexpr std::array<std::string_view, 8> kEachForItself{
    "ctl: ", "map changed: ", "map unchanged: ", "reload: ", "pose proved wrong: ", "thing ", "bay ", "incident "};

bool stands_for_itself(const LeveledLine& line) {
  return std::any_of(kEachForItself.begin(), kEachForItself.end(),
                     [&](std::string_view begin) { return line.text.starts_with(begin); });
}

/// The text with each run of digits as one 0: lines that differ in numbers alone are of one kind.
std::string kind_of(std::string_view text) {
  std::string kind;
  for (const char letter : text) {
    const bool is_digit = letter >= '0' && letter <= '9';
    if (!is_digit) {
      kind += letter;
    } else if (kind.empty() || kind.back() != '0') {
      kind += '0';
    }
  }
  return kind;
}

}  // namespace

std::optional<LeveledLine> LogThrottle::take(LeveledLine line, Clock::time_point now) {
  if (stands_for_itself(line)) return line;
  const auto [found, is_new] = kinds_.try_emplace(kind_of(line.text), Kind{.written = now});
  Kind& kind = found->second;
  if (!is_new && (now - kind.written < kPeriod || kind.held)) {
    kind.held = std::move(line);
    kind.held_since = now;
    ++kind.held_count;
    return std::nullopt;
  }
  kind.written = now;
  return line;
}

LeveledLine LogThrottle::Kind::told(Clock::time_point now) {
  LeveledLine line = *std::exchange(held, std::nullopt);
  const auto ago = std::chrono::duration_cast<std::chrono::seconds>(now - held_since).count();
  line.text += " (" + std::to_string(ago) +
               " s ago; such lines since the last: " + std::to_string(std::exchange(held_count, 0)) + ")";
  return line;
}

std::vector<LeveledLine> LogThrottle::due(Clock::time_point now) {
  std::vector<LeveledLine> lines;
  for (auto one = kinds_.begin(); one != kinds_.end();) {
    Kind& kind = one->second;
    if (now - kind.written < kPeriod) {
      ++one;
    } else if (kind.held) {
      lines.push_back(kind.told(now));
      kind.written = now;
      ++one;
    } else {
      one = kinds_.erase(one);
    }
  }
  return lines;
}

std::vector<LeveledLine> LogThrottle::rest(Clock::time_point now) {
  std::vector<LeveledLine> lines;
  for (auto& [text, kind] : kinds_) {
    if (kind.held) lines.push_back(kind.told(now));
  }
  kinds_.clear();
  return lines;
}

}  // namespace deltamap::daemon
