// SPDX-License-Identifier: Apache-2.0
// A number as people write it: the fewest digits that read back as the same double. 0.05, not 0.050000000000000003.
#pragma once

#include <charconv>
#include <string>

namespace deltamap {

[[nodiscard]] inline std::string shortest_text(double value) {
  char buffer[32];
  const auto [end, error] = std::to_chars(buffer, buffer + sizeof buffer, value);
  return error == std::errc{} ? std::string(buffer, end) : std::string{};
}

/// Such a text in a YAML file: to readers of YAML 1.1 (PyYAML) 1e-05 is a word, and 1.0e-05 the number.
[[nodiscard]] inline std::string yaml_number(std::string text) {
  const auto exponent = text.find('e');
  if (exponent != std::string::npos && text.find('.') == std::string::npos) text.insert(exponent, ".0");
  return text;
}
[[nodiscard]] inline std::string yaml_number(double value) { return yaml_number(shortest_text(value)); }

}  // namespace deltamap
