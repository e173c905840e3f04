// SPDX-License-Identifier: Apache-2.0
// Reads settings from YAML into their keys, strictly, and collects every mistake instead of ending at the first: where
// a part of the file cannot be read as YAML, its other parts still are.
#pragma once

#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "daemon/settings/reader/setting_key.hpp"
#include "daemon/settings/reader/settings_problems.hpp"

namespace deltamap::daemon {

/// What is known of the keys that were read.
struct ReadKeys {
  std::map<std::string, SettingPlace> places;  ///< where each was given last
  std::set<std::string> doubtful;              ///< given wrongly, or perhaps meant by an unknown name
  bool is_whole = true;                        ///< false: parts could not be read, any key may stand in them
};

class SettingsReader {
 public:
  /// `keys` must outlive the reader; they are assigned to as values are read. `former`: names that were
  /// keys once, each with its new name, empty where there is none.
  SettingsReader(const std::vector<SettingKey>& keys, std::map<std::string, std::string> former)
      : keys_{keys}, former_{std::move(former)} {}

  /// A whole file; mistakes in it begin with NAME:LINE:COLUMN, both from 1.
  void read_file(const std::string& yaml, const std::string& name);
  /// "key=value" as given to --set.
  void read_override(const std::string& text);

  /// A rule that `key` and `others` break together, each of them in range. Says nothing where one of them was not read
  /// as it was meant. Told where `key` was given last, else the first of the others.
  void add_contradiction(const std::string& key, const std::string& rule, const std::vector<std::string>& others);

  /// One line each: those of the file by line and column, then those of the overrides.
  [[nodiscard]] std::vector<std::string> problems() const { return problems_.lines(); }
  [[nodiscard]] const ReadKeys& read() const { return read_; }

 private:
  const std::vector<SettingKey>& keys_;
  std::map<std::string, std::string> former_;
  std::string file_;
  int overrides_ = 0;
  SettingsProblems problems_;
  ReadKeys read_;
};

}  // namespace deltamap::daemon
