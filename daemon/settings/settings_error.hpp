// SPDX-License-Identifier: Apache-2.0
// What is wrong with the settings: every mistake that was found, a line each. What main prints before it ends with 2.
#pragma once

#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace deltamap::daemon {

class SettingsError : public std::runtime_error {
 public:
  explicit SettingsError(const std::string& line) : SettingsError{std::vector{line}} {}
  /// `lines` holds at least one.
  explicit SettingsError(std::vector<std::string> lines)
      : std::runtime_error{joined(lines)}, lines_{std::move(lines)} {}

  /// In the order of the file; each names its place.
  [[nodiscard]] const std::vector<std::string>& lines() const { return lines_; }

 private:
  static std::string joined(const std::vector<std::string>& lines) {
    std::string text;
    for (const std::string& line : lines) text += (text.empty() ? "" : "\n") + line;
    return text;
  }
  std::vector<std::string> lines_;
};

}  // namespace deltamap::daemon
