// SPDX-License-Identifier: Apache-2.0
// Reads settings from YAML into their keys, strictly, and collects every mistake instead of ending at the first.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "daemon/setting_key.hpp"

namespace deltamap::daemon {

class SettingsReader {
 public:
  /// `keys` must outlive the reader; they are assigned to as values are read.
  explicit SettingsReader(const std::vector<SettingKey>& keys) : keys_{keys} {}

  /// A whole file; mistakes in it begin with NAME:LINE:COLUMN, both from 1.
  void read_file(const std::string& yaml, const std::string& name);
  /// "key=value" as given to --set.
  void read_override(const std::string& text);

  /// One line each, in the order of reading.
  [[nodiscard]] const std::vector<std::string>& problems() const { return problems_; }
  /// Where the key was given last, as a mistake names it; `otherwise` where it was not.
  [[nodiscard]] std::string place_of(const std::string& key, const std::string& otherwise) const;

 private:
  const std::vector<SettingKey>& keys_;
  std::vector<std::string> problems_;
  std::map<std::string, std::string> places_;
};

}  // namespace deltamap::daemon
