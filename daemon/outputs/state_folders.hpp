// SPDX-License-Identifier: Apache-2.0
// The folders of what a run leaves: map.store, map.newest, recording.file, control.socket, poses.socket. A fresh
// machine has none of them.
#pragma once

#include <filesystem>
#include <string>

#include "daemon/settings/settings.hpp"

namespace deltamap::daemon {

/// Makes those that are missing, where this user may. Throws SettingsError, with what to do, where the one of map.store
/// cannot be had: only a person can mend that. The others are told by whoever opens the file.
void make_state_folders(const Settings& settings, const std::string& config);

/// The part of make_state_folders() that throws; makes nothing.
void require_store_folder(const Settings& settings, const std::string& config);

/// Empty where `file` could be written into its folder, which may have to be made first; else the reason. Makes
/// nothing.
[[nodiscard]] std::string why_no_folder_for(const std::filesystem::path& file);

}  // namespace deltamap::daemon
