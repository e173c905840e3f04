// SPDX-License-Identifier: Apache-2.0
#include "core/files/replace_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <stdexcept>
#include <system_error>
#include <utility>

namespace deltamap {
namespace {

[[noreturn]] void fail(const std::filesystem::path& file, int reason) {
  throw std::runtime_error(file.string() + ": cannot be written: " + std::generic_category().message(reason));
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

/// The pieces and nothing else; 0, or why not.
int written(const std::filesystem::path& file, const std::function<std::string_view()>& next_piece) {
  const int out = ::open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  if (out < 0) return errno;
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
  const std::filesystem::path draft = file.string() + ".part";
  if (const int reason = written(draft, next_piece); reason != 0) {
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
