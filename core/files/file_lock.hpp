// SPDX-License-Identifier: Apache-2.0
// Keeps what a program writes to itself: a lock of the kernel (flock(2)) on a small file beside it that names the
// holder. It ends with the program, however that ends, so that no lock is ever stale.
#pragma once

#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>

namespace deltamap {

/// "WHAT is in use by deltamapd (pid 123)".
struct FileInUse : std::runtime_error {
  using std::runtime_error::runtime_error;
};

class FileLock {
 public:
  /// Throws FileInUse where another program, or another lock of this one, holds it; std::system_error where the lock
  /// file can neither be made nor, being another user's, be read. `what` is what the line names.
  FileLock(std::filesystem::path lock_file, const std::string& what);
  /// The lock file goes with it.
  ~FileLock();
  FileLock(FileLock&& other) noexcept;
  FileLock& operator=(FileLock&& other) noexcept;

 private:
  std::filesystem::path file_;
  int descriptor_ = -1;
};

/// The file that a name leads to through links, also where it does not exist yet. Throws std::system_error.
[[nodiscard]] std::filesystem::path file_behind(std::filesystem::path name);
/// The lock of one file, NAME.lock beside it, and of every link to it; nothing where the disk is full or read-only, so
/// that there can be none.
[[nodiscard]] std::optional<FileLock> lock_of_file(const std::filesystem::path& file);
/// Throws what lock_of_file() would throw now; takes and makes nothing.
void require_lockable_file(const std::filesystem::path& file);
/// The lock of everything in a folder that exists, .lock in it; nothing as above.
[[nodiscard]] std::optional<FileLock> lock_of_folder(const std::filesystem::path& folder);
/// Throws what lock_of_folder() would throw now; takes and makes nothing.
void require_lockable_folder(const std::filesystem::path& folder);

}  // namespace deltamap
