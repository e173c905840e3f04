// SPDX-License-Identifier: Apache-2.0
// A disk that fails, for a program that knows nothing of it: preloaded (LD_PRELOAD), it stands before the calls that
// change files below one folder. It lets some of them fail as a full or broken disk does, or cuts the power: the
// process dies at once, and what was not synced is lost, sector by sector, at random.
//
// DELTAMAP_DISK="FOLDER SEED RATE CUT LOG": a call fails with the probability RATE (-1: none does, and no sync is one);
// the power goes before call CUT (0: never); a line for each failure is appended to the file LOG, which lies outside of
// FOLDER.
#undef _FILE_OFFSET_BITS  // both spellings of each call are defined here: that of 32-bit and that of 64-bit places in a
                          // file
#include <dlfcn.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <sys/uio.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdarg>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <map>
#include <mutex>
#include <random>
#include <string>
#include <vector>

namespace {

constexpr off64_t kSector = 512;

/// The call behind ours; found at its first use, which may come before this library's own constructors.
template <typename Call>
Call behind(const char* name) {
  return reinterpret_cast<Call>(dlsym(RTLD_NEXT, name));
}

int real_open(const char* path, int flags, mode_t mode = 0) {
  static const auto call = behind<int (*)(const char*, int, ...)>("open");
  return call(path, flags, mode);
}
ssize_t real_write(int descriptor, const void* data, size_t size) {
  static const auto call = behind<ssize_t (*)(int, const void*, size_t)>("write");
  return call(descriptor, data, size);
}
ssize_t real_pwrite(int descriptor, const void* data, size_t size, off64_t at) {
  static const auto call = behind<ssize_t (*)(int, const void*, size_t, off64_t)>("pwrite64");
  return call(descriptor, data, size, at);
}
ssize_t real_writev(int descriptor, const iovec* parts, int count) {
  static const auto call = behind<ssize_t (*)(int, const iovec*, int)>("writev");
  return call(descriptor, parts, count);
}
int real_fsync(int descriptor) {
  static const auto call = behind<int (*)(int)>("fsync");
  return call(descriptor);
}
int real_ftruncate(int descriptor, off64_t size) {
  static const auto call = behind<int (*)(int, off64_t)>("ftruncate64");
  return call(descriptor, size);
}
int real_rename(const char* from, const char* to) {
  static const auto call = behind<int (*)(const char*, const char*)>("rename");
  return call(from, to);
}

/// What the disk holds for sure of a file that was written to and not synced since.
struct Unsynced {
  std::string path;  ///< the newest
  off64_t size = 0;  ///< on disk
  bool is_new = false;
  std::map<off64_t, std::array<char, kSector>> sectors;  ///< on disk, where they were written over
};

struct Rename {
  std::string from;
  std::string to;
  std::string before;  ///< a second name of the file that was replaced; empty: there was none
};

class Disk {
 public:
  Disk() {
    const char* wanted = std::getenv("DELTAMAP_DISK");
    char folder[1024] = "";
    char log[1024] = "";
    unsigned seed = 0;
    if (wanted == nullptr || std::sscanf(wanted, "%1023s %u %lf %ld %1023s", folder, &seed, &rate_, &cut_, log) != 5) {
      return;
    }
    folder_ = std::string(folder) + "/";
    random_.seed(seed);
    log_ = real_open(log, O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0644);
  }

  std::recursive_mutex& mutex() { return mutex_; }

  /// Empty where the file is none of ours. The memory that SQLite's readers share is on no disk; locks are not content.
  [[nodiscard]] std::string path_of(int descriptor) const {
    if (folder_.empty()) return "";
    char name[64];
    char path[1024];
    (void)std::snprintf(name, sizeof name, "/proc/self/fd/%d", descriptor);
    const ssize_t size = ::readlink(name, path, sizeof path - 1);
    if (size <= 0) return "";
    const std::string found{path, static_cast<std::size_t>(size)};
    return found + "/" == folder_ ? found : if_ours(found);
  }
  [[nodiscard]] std::string if_ours(std::string path) const {
    const bool is_ours = !folder_.empty() && path.starts_with(folder_) && !path.ends_with("-shm") &&
                         !path.ends_with(".lock") && path.find(" (deleted)") == std::string::npos;
    return is_ours ? path : "";
  }

  /// Before each call that changes something: the power may go here.
  void before_call() {
    ++calls_;
    if (cut_ > 0 && calls_ >= cut_) cut_power();
  }
  /// One of the reasons, or 0: the call is done.
  int failure(const char* call, const std::string& path, std::initializer_list<int> reasons) {
    before_call();
    if (!chance(rate_)) return 0;
    const int reason = *(reasons.begin() + static_cast<long>(random_() % reasons.size()));
    tell(std::string(call) + " " + path + " " + std::strerror(reason));
    return reason;
  }
  /// How much of it is written: a disk that fills cuts in the middle.
  std::size_t short_of(const std::string& path, std::size_t size) {
    if (size < 2 || !chance(rate_ / 2)) return size;
    tell("short write " + path);
    return 1 + random_() % (size - 1);
  }

  Unsynced& written(int descriptor, const std::string& path) {
    struct stat64 state {};
    (void)::fstat64(descriptor, &state);
    const auto [found, is_new] = unsynced_.try_emplace(state.st_ino);
    if (is_new) found->second.size = state.st_size;
    found->second.path = path;
    return found->second;
  }
  void overwrite(int descriptor, const std::string& path, off64_t from, off64_t to) {
    Unsynced& file = written(descriptor, path);
    const int reader = real_open(path.c_str(), O_RDONLY | O_CLOEXEC);
    for (off64_t at = from / kSector * kSector; at < std::min(to, file.size); at += kSector) {
      const auto [sector, is_new] = file.sectors.try_emplace(at);
      if (is_new && ::pread64(reader, sector->second.data(), kSector, at) < 0) file.sectors.erase(sector);
    }
    ::close(reader);
  }
  void begin(int descriptor, const std::string& path) {
    struct stat64 state {};
    (void)::fstat64(descriptor, &state);
    unsynced_[state.st_ino] = {.path = path, .size = 0, .is_new = true, .sectors = {}};
  }
  void sync(int descriptor) {
    if (rate_ < 0.0) return;
    struct stat64 state {};
    (void)::fstat64(descriptor, &state);
    if (!S_ISDIR(state.st_mode)) {
      unsynced_.erase(state.st_ino);
      return;
    }
    for (const Rename& one : renames_) ::unlink(one.before.c_str());
    renames_.clear();
  }
  void renamed(const std::string& from, const std::string& to) {
    Rename one{from, to, to + ".before-" + std::to_string(++calls_)};
    if (::link(to.c_str(), one.before.c_str()) != 0) one.before.clear();
    renames_.push_back(std::move(one));
    for (auto& [inode, file] : unsynced_) {
      if (file.path == to) file.path = renames_.back().before;
      if (file.path == from) file.path = to;
    }
  }

 private:
  bool chance(double share) { return std::uniform_real_distribution<>{}(random_) < share; }
  void tell(const std::string& line) const {
    const std::string text = line + "\n";
    (void)!real_write(log_, text.data(), text.size());
  }

  [[noreturn]] void cut_power() {
    for (const auto& [inode, file] : unsynced_) lose(inode, file);
    while (!renames_.empty() && chance(0.5)) undo_newest_rename();  // a folder keeps its changes in their order
    for (const Rename& one : renames_) ::unlink(one.before.c_str());
    tell("power cut before call " + std::to_string(calls_));
    (void)::kill(::getpid(), SIGKILL);
    std::abort();
  }
  void lose(ino64_t inode, const Unsynced& file) {
    struct stat64 present {};
    if (::stat64(file.path.c_str(), &present) != 0 || present.st_ino != inode) return;  // it was removed
    if (file.is_new && chance(0.3)) {
      ::unlink(file.path.c_str());
      return;
    }
    const int writer = real_open(file.path.c_str(), O_RDWR | O_CLOEXEC);
    if (writer < 0) return;
    for (const auto& [at, content] : file.sectors) {
      if (chance(0.5))
        (void)!real_pwrite(writer, content.data(), static_cast<std::size_t>(std::min(kSector, file.size - at)), at);
    }
    struct stat64 state {};
    (void)::fstat64(writer, &state);
    const std::array<char, kSector> nothing{};
    for (off64_t at = file.size; at < state.st_size; at += kSector - at % kSector) {
      const off64_t length = std::min(kSector - at % kSector, state.st_size - at);
      if (chance(0.5)) (void)!real_pwrite(writer, nothing.data(), static_cast<std::size_t>(length), at);
    }
    if (chance(0.5)) (void)!real_ftruncate(writer, file.size);
    ::close(writer);
  }
  void undo_newest_rename() {
    const Rename& one = renames_.back();
    (void)real_rename(one.to.c_str(), one.from.c_str());
    if (!one.before.empty()) (void)real_rename(one.before.c_str(), one.to.c_str());
    renames_.pop_back();
  }

  std::recursive_mutex mutex_;
  std::string folder_;  // with the stroke at its end
  std::mt19937 random_;
  double rate_ = 0.0;
  long cut_ = 0;
  long calls_ = 0;
  int log_ = -1;
  std::map<ino64_t, Unsynced> unsynced_;
  std::vector<Rename> renames_;
};

Disk& disk() {
  static Disk the_disk;
  return the_disk;
}

/// The answer of a call that fails.
template <typename Answer>
Answer failed(int reason) {
  errno = reason;
  return static_cast<Answer>(-1);
}

int opened(const char* path, int flags, mode_t mode) {
  const std::lock_guard lock{disk().mutex()};
  const std::string file = (flags & (O_CREAT | O_TRUNC)) != 0 ? disk().if_ours(path) : "";
  if (file.empty()) return real_open(path, flags, mode);
  const bool is_new = ::access(path, F_OK) != 0;
  if (!is_new && (flags & O_TRUNC) == 0) return real_open(path, flags, mode);  // needs no room
  if (const int reason = disk().failure("open", file, {ENOSPC, EIO}); reason != 0) return failed<int>(reason);
  if (!is_new && (flags & O_TRUNC) != 0) {
    const int old = real_open(path, O_RDONLY | O_CLOEXEC);
    struct stat64 state {};
    (void)::fstat64(old, &state);
    disk().overwrite(old, file, 0, state.st_size);
    ::close(old);
  }
  const int descriptor = real_open(path, flags, mode);
  if (descriptor >= 0 && is_new) disk().begin(descriptor, file);
  return descriptor;
}

ssize_t written_at(int descriptor, const void* data, size_t size, off64_t at, bool is_appended) {
  const std::lock_guard lock{disk().mutex()};
  const std::string file = disk().path_of(descriptor);
  const auto write = [&](size_t length) {
    return is_appended ? real_write(descriptor, data, length) : real_pwrite(descriptor, data, length, at);
  };
  if (file.empty()) return write(size);
  if (const int reason = disk().failure("write", file, {ENOSPC, EIO}); reason != 0) return failed<ssize_t>(reason);
  const size_t length = disk().short_of(file, size);
  if (is_appended) at = ::lseek(descriptor, 0, SEEK_CUR);
  disk().overwrite(descriptor, file, at, at + static_cast<off64_t>(length));
  return write(length);
}

int synced(int descriptor) {
  const std::lock_guard lock{disk().mutex()};
  const std::string file = disk().path_of(descriptor);
  if (file.empty()) return real_fsync(descriptor);
  if (const int reason = disk().failure("sync", file, {EIO, ENOSPC}); reason != 0) return failed<int>(reason);
  disk().sync(descriptor);
  return 0;  // the page cache outlives the process: a real sync would only take time
}

int cut_short(int descriptor, off64_t size) {
  const std::lock_guard lock{disk().mutex()};
  const std::string file = disk().path_of(descriptor);
  if (file.empty()) return real_ftruncate(descriptor, size);
  if (const int reason = disk().failure("truncate", file, {EIO, ENOSPC}); reason != 0) return failed<int>(reason);
  struct stat64 state {};
  (void)::fstat64(descriptor, &state);
  disk().overwrite(descriptor, file, size, state.st_size);
  return real_ftruncate(descriptor, size);
}

}  // namespace

extern "C" {

int open(const char* path, int flags, ...) {
  va_list rest;
  va_start(rest, flags);
  const auto mode = static_cast<mode_t>(va_arg(rest, unsigned));
  va_end(rest);
  return opened(path, flags, mode);
}

int open64(const char* path, int flags, ...) {
  va_list rest;
  va_start(rest, flags);
  const auto mode = static_cast<mode_t>(va_arg(rest, unsigned));
  va_end(rest);
  return opened(path, flags, mode);
}

ssize_t write(int descriptor, const void* data, size_t size) { return written_at(descriptor, data, size, 0, true); }

ssize_t pwrite(int descriptor, const void* data, size_t size, off_t at) {
  return written_at(descriptor, data, size, at, false);
}

ssize_t pwrite64(int descriptor, const void* data, size_t size, off64_t at) {
  return written_at(descriptor, data, size, at, false);
}

ssize_t writev(int descriptor, const iovec* parts, int count) {
  if (disk().path_of(descriptor).empty()) return real_writev(descriptor, parts, count);
  std::string all;
  for (int i = 0; i < count; ++i) all.append(static_cast<const char*>(parts[i].iov_base), parts[i].iov_len);
  return written_at(descriptor, all.data(), all.size(), 0, true);
}

int fsync(int descriptor) { return synced(descriptor); }
int fdatasync(int descriptor) { return synced(descriptor); }
int ftruncate(int descriptor, off_t size) noexcept { return cut_short(descriptor, size); }
int ftruncate64(int descriptor, off64_t size) noexcept { return cut_short(descriptor, size); }

int rename(const char* from, const char* to) noexcept {
  const std::lock_guard lock{disk().mutex()};
  const std::string target = disk().if_ours(to);
  if (target.empty()) return real_rename(from, to);
  if (const int reason = disk().failure("rename", target, {EIO, ENOSPC}); reason != 0) return failed<int>(reason);
  disk().renamed(from, to);
  return real_rename(from, to);
}

}  // extern "C"
