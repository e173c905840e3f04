// SPDX-License-Identifier: Apache-2.0
// The settings in force, and their exchange while the daemon runs (`deltamap ctl reload`, SIGHUP). Values of live keys
// are taken; of all others it is told that they wait for a restart. A file with a mistake, or one that has lost what it
// said (lost_keys.hpp), changes nothing.
#pragma once

#include <functional>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "daemon/settings/settings_reading.hpp"

namespace deltamap::daemon {

class LiveSettings {
 public:
  /// `read` reads the file and the overrides of the start again; it throws SettingsError.
  LiveSettings(const SettingsReading& at_start, std::function<SettingsReading()> read)
      : in_force_{at_start.settings}, last_key_{at_start.last_key}, read_{std::move(read)} {}

  struct Outcome {
    bool done = true;
    std::vector<std::string> lines;  ///< what was taken, what waits for a restart; or what is wrong; at least one
  };
  /// Any thread; one after another. `take` hands the new settings to those who use them, or answers false where they
  /// cannot take them now: then nothing has changed.
  [[nodiscard]] Outcome reload(const std::function<bool(const Settings&)>& take);

  /// Any thread.
  [[nodiscard]] Settings in_force() const {
    const std::scoped_lock lock{mutex_};
    return in_force_;
  }

 private:
  mutable std::mutex mutex_;
  Settings in_force_;
  std::string last_key_;  // of the file, when it was taken last
  std::function<SettingsReading()> read_;
};

/// `in_force` with the live keys of `wanted`, and a line for every key in which both differ.
struct MergedSettings {
  Settings settings;
  std::vector<std::string> taken;          ///< "navigation.safety.margin_m: 0.3 (before 0.2)"
  std::vector<std::string> for_a_restart;  ///< "laser.port: /dev/a (in force /dev/b)"
};
[[nodiscard]] MergedSettings with_live_keys_of(const Settings& wanted, const Settings& in_force);

}  // namespace deltamap::daemon
