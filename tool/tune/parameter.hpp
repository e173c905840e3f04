// SPDX-License-Identifier: Apache-2.0
// A key of the settings and the values that it is tried with.
#pragma once

#include <string>
#include <vector>

namespace deltamap::tool::tune {

struct Parameter {
  std::string key;
  std::vector<std::string> values{};  ///< as YAML, in order, each once
  // Of a range:
  double low = 0.0;
  double high = 0.0;
  bool is_range = false;
  bool is_logarithmic = false;  ///< equal factors, not equal steps
  bool is_whole = false;

  /// The value at a share of the range, or of the list, 0 to 1, as YAML.
  [[nodiscard]] std::string at(double share) const;
};

/// "key=a:b:n", "key=a:b:n:log", or "key=v,v,…" for the values themselves. Throws SettingsError: an unknown key (the
/// nearest one is named), one that changes nothing of a replay, a value outside of the key's range, a range that is
/// none.
[[nodiscard]] Parameter parameter_of(const std::string& text);

}  // namespace deltamap::tool::tune
