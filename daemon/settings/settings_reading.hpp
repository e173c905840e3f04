// SPDX-License-Identifier: Apache-2.0
// Settings of a run of the daemon, which has ports and outputs (run_contradictions.hpp): as far as they could be read,
// beside all mistakes, for --check-config, which looks at the rest all the same; or without a mistake.
#pragma once

#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "daemon/settings/settings.hpp"

namespace deltamap::daemon {

struct SettingsReading {
  Settings settings;                    ///< a key with a mistake is as delivered
  std::vector<std::string> problems{};  ///< as of SettingsError; empty: the settings are good
  std::set<std::string> given{};        ///< keys that were read, with a value that they take or not
  std::set<std::string> doubtful{};     ///< keys of which it is not known what they were meant to be
  bool is_whole = true;                 ///< false: parts of the file could not be read, other keys may stand in them
  std::string file{};                   ///< its name
  std::string last_key{};               ///< that the file gives; empty: it gives none
  bool ends_its_line = true;            ///< false: the file ends in the middle of a line

  /// Whether the value of `key` is what was meant.
  [[nodiscard]] bool knows(const std::string& key) const {
    return !doubtful.contains(key) && (is_whole || given.contains(key));
  }
};

/// Throws SettingsError only where the file itself cannot be read.
[[nodiscard]] SettingsReading look_at_settings(const std::filesystem::path& file,
                                               const std::vector<std::string>& overrides);
/// The same without a mistake: throws SettingsError with all of them.
[[nodiscard]] SettingsReading read_settings_of_a_run(const std::filesystem::path& file,
                                                     const std::vector<std::string>& overrides);

}  // namespace deltamap::daemon
