// SPDX-License-Identifier: Apache-2.0
#include "core/files/replace_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <optional>
#include <system_error>
#include <utility>

namespace deltamap {
namespace {

[[noreturn]] void fail(const std::filesystem::path& file, int reason) {
  throw std::system_error(reason, std::generic_category(), file.string() + ": cannot be written");
}

/// 0, or why not. A file system that knows no syncing (EINVAL) has done what it can.
int synced(int descriptor) {
  if (descriptor < 0) return errno;
  const int reason = ::fsync(descriptor) == 0 || errno == EINVAL ? 0 : errno;
  return ::close(descriptor) == 0 || reason != 0 ? reason : errno;
}

/// 0, or why not.
int appended(int out, std::string_view content) {
  while (!content.empty()) {
    const ssize_t n = ::write(out, content.data(), content.size());
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return n < 0 ? errno : ENOSPC;
    content.remove_prefix(static_cast<std::size_t>(n));
  }
  return 0;
}

/// Whose a file is, and who may do what with it.
struct FileRights {
  mode_t mode;
  uid_t owner;
  gid_t group;
};

/// Of a file that stands there; nothing where none does.
std::optional<FileRights> rights_of(const std::filesystem::path& file) {
  struct stat found {};
  if (::stat(file.c_str(), &found) != 0 || !S_ISREG(found.st_mode)) return std::nullopt;
  return FileRights{found.st_mode & 0777u, found.st_uid, found.st_gid};
}

/// As far as this process may give a file away, and the file system knows owners and modes.
void give(int file, const FileRights& rights) {
  const bool is_given = ::fchown(file, rights.owner, rights.group) == 0;
  if (!is_given) (void)!::fchown(file, static_cast<uid_t>(-1), rights.group);
  (void)!::fchmod(file, rights.mode);  // whatever the umask took from it
}

/// The pieces and nothing else; 0, or why not.
int written(const std::filesystem::path& file, const std::optional<FileRights>& rights,
            const std::function<std::string_view()>& next_piece) {
  ::unlink(file.c_str());  // of a run that was killed, perhaps another user's, or nobody's to write
  const int out = ::open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, rights ? rights->mode : 0644);
  if (out < 0) return errno;
  if (rights) give(out, *rights);
  int reason = 0;
  for (std::string_view piece = next_piece(); reason == 0 && !piece.empty();) {
    reason = appended(out, piece);
    if (reason == 0) piece = next_piece();
  }
  return ::close(out) == 0 || reason != 0 ? reason : errno;
}

}  // namespace

void replace_file(const std::filesystem::path& file, std::string_view content) {
  replace_file(file, [&] { return std::exchange(content, {}); });
}

void replace_file(const std::filesystem::path& file, const std::function<std::string_view()>& next_piece) {
  write_file_like(file, file, next_piece);
}

void write_file_like(const std::filesystem::path& model, const std::filesystem::path& file,
                     const std::function<std::string_view()>& next_piece) {
  const std::filesystem::path draft = file.string() + ".part";
  if (const int reason = written(draft, rights_of(model), next_piece); reason != 0) {
    ::unlink(draft.c_str());
    fail(file, reason);
  }
  try {
    move_into_place(draft, file);
  } catch (const std::runtime_error&) {
    ::unlink(draft.c_str());
    throw;
  }
}

void move_into_place(const std::filesystem::path& draft, const std::filesystem::path& file) {
  if (const int reason = synced(::open(draft.c_str(), O_RDONLY | O_CLOEXEC)); reason != 0) fail(file, reason);
  if (::rename(draft.c_str(), file.c_str()) != 0) fail(file, errno);
  // The new name is an entry of the folder: without this a power cut may bring the old file back.
  const std::filesystem::path folder = file.has_parent_path() ? file.parent_path() : ".";
  if (const int reason = synced(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)); reason != 0) {
    fail(file, reason);
  }
}

}  // namespace deltamap
