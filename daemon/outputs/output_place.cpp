// SPDX-License-Identifier: Apache-2.0
#include "daemon/outputs/output_place.hpp"

#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

#include "core/files/access.hpp"
#include "core/files/file_lock.hpp"
#include "daemon/outputs/outputs.hpp"
#include "daemon/outputs/state_folders.hpp"
#include "daemon/settings/settings.hpp"
#include "daemon/settings/start_error.hpp"

namespace deltamap::daemon {
namespace {

namespace fs = std::filesystem;

std::string cannot_be(const char* done, const fs::path& place, int reason) {
  return place.string() + ": cannot be " + done + ": " + std::generic_category().message(reason);
}

/// Empty where the folder is writable, the reason on a read-only file system, which may change while the robot runs.
/// Throws StartError where this user lacks the permission.
std::string why_not_writable(const fs::path& folder, const fs::path& what) {
  if (may_access(folder, W_OK | X_OK)) return "";
  const int reason = errno;
  if (reason != EROFS) throw StartError(cannot_be("written", what, reason));
  return cannot_be("written", what, reason);
}

fs::path folder_of(const fs::path& file) { return file.has_parent_path() ? file.parent_path() : "."; }

void require_file_in_folder(const fs::path& file) {
  std::error_code error;
  if (!fs::is_directory(folder_of(file), error)) {
    const std::string why = why_no_folder_for(file);
    throw StartError(file.string() +
                     ": cannot be written: " + (why.empty() ? folder_of(file).string() + " does not exist" : why));
  }
  if (fs::is_directory(file, error)) throw StartError(file.string() + ": is a directory");
}

/// Throws StartError where an existing file cannot be replaced by a rename: in a folder with the sticky bit only the
/// owner of file or folder may do that.
void require_replaceable(const fs::path& file) {
  struct stat folder {};
  struct stat old {};
  if (::stat(folder_of(file).c_str(), &folder) != 0 || ::lstat(file.c_str(), &old) != 0) return;
  const uid_t user = ::geteuid();
  const bool is_allowed = (folder.st_mode & S_ISVTX) == 0 || user == 0 || user == old.st_uid || user == folder.st_uid;
  if (!is_allowed) throw StartError(cannot_be("replaced", file, EPERM));
}

}  // namespace

std::string judged_store_place(const fs::path& store) {
  const fs::path file = or_start_error([&] { return file_behind(store); });
  require_file_in_folder(file);
  std::error_code error;
  const bool is_there = fs::exists(file, error);
  if (is_there && !fs::is_regular_file(file, error)) throw StartError(file.string() + ": is no plain file");
  if (is_there && !may_access(file, R_OK)) throw StartError(cannot_be("read", file, errno));
  or_start_error([&] { require_lockable_file(file); });
  const bool is_writable = (!is_there || may_access(file, W_OK)) && may_access(folder_of(file), W_OK | X_OK);
  return is_writable ? "" : cannot_be("written", file, errno);
}

std::string judged_file_place(const fs::path& name) {
  const fs::path file = or_start_error([&] { return file_behind(name); });
  require_file_in_folder(file);
  std::string why = why_not_writable(folder_of(file), file);
  or_start_error([&] { require_lockable_file(file); });
  require_replaceable(file);
  return why;
}

std::string judged_out_place(const fs::path& out, const Settings& settings) {
  std::error_code error;
  if (!fs::is_directory(out, error)) {
    throw StartError(out.string() + (error ? ": cannot be opened: " + error.message() : ": is no folder"));
  }
  std::string why = why_not_writable(out, out);
  or_start_error([&] { require_lockable_folder(out); });
  try {
    require_map_elsewhere(settings.map.file, out);
    require_no_other_maps(out, settings.map.store);
  } catch (const FileInUse&) {
    throw;
  } catch (const std::runtime_error& error_) {
    throw StartError(error_.what());
  }
  return why;
}

}  // namespace deltamap::daemon
