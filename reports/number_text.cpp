// SPDX-License-Identifier: Apache-2.0
#include "reports/number_text.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <cstdlib>

namespace deltamap::reports {
namespace {

bool is_part_of_number(char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0 || c == '.'; }

}  // namespace

std::string text_of(double number) {
  if (std::isnan(number)) return "";
  std::array<char, 32> text{};
  (void)std::snprintf(text.data(), text.size(), "%.6g", number);
  return text.data();
}

std::string short_text(double value) {
  if (!std::isfinite(value)) return "–";
  char text[32];
  const bool is_whole = value == std::round(value) && std::abs(value) < 1e15;
  (void)std::snprintf(text, sizeof text, is_whole || std::abs(value) >= 100.0 ? "%.0f" : "%.3g", value);
  return text;
}

std::string shortened(const std::string& text) {
  std::string answer;
  for (std::size_t at = 0; at < text.size();) {
    std::size_t end = at;
    while (end < text.size() && is_part_of_number(text[end])) ++end;
    const std::string token = text.substr(at, end - at);
    const bool is_decimal = std::count(token.begin(), token.end(), '.') == 1 && token.size() > 2 &&
                            token.front() != '.' && token.back() != '.';
    if (end == at) {
      answer += text[at++];
      continue;
    }
    char* rest = nullptr;
    const double value = std::strtod(text.c_str() + at, &rest);
    const auto read = static_cast<std::size_t>(rest - text.c_str()) - at;  // with an exponent
    answer += is_decimal ? short_text(value) : token;
    at += is_decimal ? read : token.size();
  }
  return answer;
}

}  // namespace deltamap::reports
