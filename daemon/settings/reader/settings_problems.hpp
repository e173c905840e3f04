// SPDX-License-Identifier: Apache-2.0
// The mistakes of a settings file and of the overrides behind it, each with its place.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace deltamap::daemon {

/// Where something stands: a line and column of the file, or an override.
struct SettingPlace {
  std::string name;  ///< of the file, or "--set key=value"
  int source = 0;    ///< 0: the file; n: the nth override
  int line = 0;      ///< from 1; 0: none
  int column = 0;    ///< from 1
};

class SettingsProblems {
 public:
  static constexpr std::size_t kMostTold = 50;

  /// `what` is "key: rule that is broken", or what is wrong with the text.
  void add(SettingPlace place, std::string what);

  [[nodiscard]] bool empty() const { return problems_.empty(); }
  /// One line each, whatever line ends a value has, "file:line:column: what": the file's by line and column, then the
  /// overrides' in their order. The first fifty, and where more follow: a file with more is another kind of file.
  [[nodiscard]] std::vector<std::string> lines() const;

 private:
  struct Problem {
    SettingPlace place;
    std::string what;
  };
  std::vector<Problem> problems_;
};

}  // namespace deltamap::daemon
