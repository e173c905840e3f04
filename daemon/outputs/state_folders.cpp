// SPDX-License-Identifier: Apache-2.0
#include "daemon/outputs/state_folders.hpp"

#include <pwd.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <system_error>

#include "core/files/access.hpp"

namespace deltamap::daemon {
namespace {

namespace fs = std::filesystem;

fs::path absolute_folder_of(const fs::path& file) { return fs::absolute(file).lexically_normal().parent_path(); }

std::string user_name() {
  std::array<char, 4096> names{};
  passwd entry{};
  passwd* found = nullptr;
  (void)::getpwuid_r(::geteuid(), &entry, names.data(), names.size(), &found);
  return found != nullptr ? found->pw_name : "USER";
}

void make_folder_of(const fs::path& file) {
  std::error_code told_by_whoever_opens_the_file;
  if (!file.empty()) fs::create_directories(absolute_folder_of(file), told_by_whoever_opens_the_file);
}

}  // namespace

std::string why_no_folder_for(const fs::path& file) {
  fs::path folder = absolute_folder_of(file);
  std::error_code error;
  fs::file_status status = fs::status(folder, error);
  // Climb to the nearest folder that can be seen: those below are missing, or in a folder that may not be entered.
  while (!fs::exists(status) && folder.has_relative_path()) {
    folder = folder.parent_path();
    status = fs::status(folder, error);
  }
  if (fs::exists(status) && !fs::is_directory(status)) return folder.string() + " is no folder";
  if (may_access(folder, W_OK | X_OK)) return "";
  return folder.string() + " cannot be written to (" + std::generic_category().message(errno) + ")";
}

void require_store_folder(const Settings& settings, const std::string& config) {
  std::error_code ignored;
  if (settings.map.store.empty() || fs::exists(settings.map.store, ignored)) return;
  const std::string why = why_no_folder_for(settings.map.store);
  if (why.empty()) return;
  const fs::path folder = absolute_folder_of(settings.map.store);
  // `install -d` is advised for a missing folder only: it would change owner and mode of an existing one.
  const bool is_missing = fs::status(folder, ignored).type() == fs::file_type::not_found;
  throw SettingsError(
      config + ": 'map.store': " + why + ": give this user " +
      (is_missing ? "the folder (sudo install -d -o " + user_name() + " " + folder.string() + ") or another file"
                  : "a folder of its own (sudo install -d -o " + user_name() + " FOLDER) and name a file in it") +
      " (--set map.store=FILE)");
}

void make_state_folders(const Settings& settings, const std::string& config) {
  for (const std::string* file : {&settings.map.store, &settings.map.newest, &settings.recording.file,
                                  &settings.control.socket, &settings.poses.socket}) {
    make_folder_of(*file);
  }
  require_store_folder(settings, config);
}

}  // namespace deltamap::daemon
