// SPDX-License-Identifier: Apache-2.0
#include "core/files/file_lock.hpp"

#include <errno.h>
#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <system_error>
#include <utility>

#include "core/files/access.hpp"

namespace deltamap {
namespace {

std::string text_in(int descriptor) {
  std::array<char, 128> text{};
  const ssize_t size = ::pread(descriptor, text.data(), text.size(), 0);
  const std::string all{text.data(), static_cast<std::size_t>(size > 0 ? size : 0)};
  return all.substr(0, all.find('\n'));
}

/// "deltamapd (pid 123)".
std::string own_name() {
  return std::string(program_invocation_short_name) + " (pid " + std::to_string(::getpid()) + ")";
}

/// The name still leads to the file that was locked: its holder removes it in the end.
bool is_current(int descriptor, const std::filesystem::path& file) {
  struct stat locked {};
  struct stat named {};
  return ::fstat(descriptor, &locked) == 0 && ::stat(file.c_str(), &named) == 0 && locked.st_ino == named.st_ino &&
         locked.st_dev == named.st_dev;
}

[[noreturn]] void fail(const std::filesystem::path& file) {
  throw std::system_error(errno, std::generic_category(), file.string() + ": cannot be locked");
}

struct OpenLockFile {
  int descriptor = -1;
  bool may_write = true;
};

/// The file of another user may at least be read, and be locked so. Throws std::system_error.
OpenLockFile opened(const std::filesystem::path& file) {
  const int to_write = ::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0644);
  if (to_write >= 0) return {to_write, true};
  if (errno != EACCES) fail(file);
  const int to_read = ::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW);
  if (to_read >= 0) return {to_read, false};
  errno = EACCES;  // not ENOENT: it is the folder that forbids
  fail(file);
}

[[noreturn]] void refuse_in_use(int descriptor, const std::string& what) {
  const std::string holder = text_in(descriptor);
  ::close(descriptor);
  throw FileInUse(what + ": is in use by " + (holder.empty() ? "another program" : holder));
}

void require_lockable(const std::filesystem::path& lock_file, const std::string& what) {
  const int descriptor = ::open(lock_file.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW);
  if (descriptor < 0) {
    if (errno != ENOENT) fail(lock_file);
    const std::filesystem::path folder = lock_file.parent_path();
    const bool may_make = may_access(folder, W_OK | X_OK) || errno == EROFS;
    if (!may_make) fail(lock_file);
    return;
  }
  struct stat found {};
  if (::fstat(descriptor, &found) == 0 && S_ISDIR(found.st_mode)) {
    ::close(descriptor);
    errno = EISDIR;
    fail(lock_file);
  }
  // Shared: two that only look are not in each other's way.
  if (::flock(descriptor, LOCK_SH | LOCK_NB) != 0 && errno == EWOULDBLOCK) refuse_in_use(descriptor, what);
  ::close(descriptor);
}

std::filesystem::path lock_file_of(const std::filesystem::path& file) { return file_behind(file).string() + ".lock"; }
std::filesystem::path lock_file_in(const std::filesystem::path& folder) { return folder / ".lock"; }

std::optional<FileLock> locked(const std::filesystem::path& lock_file, const std::string& what) {
  try {
    return FileLock{lock_file, what};
  } catch (const std::system_error& error) {
    const int reason = error.code().value();
    if (reason == ENOSPC || reason == EDQUOT || reason == EROFS) return std::nullopt;
    throw;
  }
}

}  // namespace

FileLock::FileLock(std::filesystem::path lock_file, const std::string& what) : file_{std::move(lock_file)} {
  for (;;) {
    const auto [descriptor, may_write] = opened(file_);
    if (::flock(descriptor, LOCK_EX | LOCK_NB) != 0) {
      if (errno == EWOULDBLOCK) refuse_in_use(descriptor, what);
      const int reason = errno;
      ::close(descriptor);
      errno = reason;
      fail(file_);
    }
    // Nobody holds what another user has left: one of its own names the holder.
    const bool is_replaced = !may_write && is_current(descriptor, file_) && ::unlink(file_.c_str()) == 0;
    if (!is_replaced && is_current(descriptor, file_)) {
      descriptor_ = descriptor;
      break;
    }
    ::close(descriptor);
  }
  // A full disk has no room for the name: the lock holds without it.
  const std::string name = own_name() + "\n";
  if (::ftruncate(descriptor_, 0) == 0) (void)!::pwrite(descriptor_, name.data(), name.size(), 0);
}

FileLock::~FileLock() {
  if (descriptor_ < 0) return;
  ::unlink(file_.c_str());  // while it is held: nobody else removes it
  ::close(descriptor_);
}

FileLock::FileLock(FileLock&& other) noexcept
    : file_{std::move(other.file_)}, descriptor_{std::exchange(other.descriptor_, -1)} {}

FileLock& FileLock::operator=(FileLock&& other) noexcept {
  std::swap(file_, other.file_);
  std::swap(descriptor_, other.descriptor_);
  return *this;
}

std::filesystem::path file_behind(std::filesystem::path name) {
  constexpr int kMostLinks = 40;  // as the kernel has it
  namespace fs = std::filesystem;
  const std::string given = name.string();
  std::error_code error;
  const auto expect_seen = [&] {
    if (error) throw std::system_error(error, given + ": cannot be looked at");
  };
  name = fs::absolute(name, error);  // the folder of a bare name is known, too
  expect_seen();
  for (int i = 0; i < kMostLinks && fs::is_symlink(fs::symlink_status(name, error)); ++i) {
    const fs::path target = fs::read_symlink(name, error);
    expect_seen();
    name = name.parent_path() / target;
  }
  name = fs::weakly_canonical(name, error);
  expect_seen();
  return name;
}

std::optional<FileLock> lock_of_file(const std::filesystem::path& file) {
  return locked(lock_file_of(file), file.string());
}

void require_lockable_file(const std::filesystem::path& file) { require_lockable(lock_file_of(file), file.string()); }

std::optional<FileLock> lock_of_folder(const std::filesystem::path& folder) {
  return locked(lock_file_in(folder), folder.string());
}

void require_lockable_folder(const std::filesystem::path& folder) {
  require_lockable(lock_file_in(folder), folder.string());
}

}  // namespace deltamap
