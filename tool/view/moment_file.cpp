// SPDX-License-Identifier: Apache-2.0
#include "tool/view/moment_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <system_error>

#include "daemon/dashboard/wire.hpp"

namespace deltamap::tool {
namespace {

[[noreturn]] void fail(const std::filesystem::path& folder, const char* what) {
  throw std::system_error(errno, std::generic_category(), folder.string() + ": " + what);
}

int nameless_file_in(const std::filesystem::path& folder) {
  std::string name = (folder / "deltamap-view-XXXXXX").string();
  const int descriptor = ::mkostemp(name.data(), O_CLOEXEC);
  if (descriptor < 0) fail(folder, "cannot hold the scans of the run");
  (void)::unlink(name.c_str());
  return descriptor;
}

}  // namespace

MomentFile::MomentFile(const std::filesystem::path& folder) : folder_{folder}, descriptor_{nameless_file_in(folder)} {}

MomentFile::~MomentFile() { ::close(descriptor_); }

void MomentFile::add(Timestamp time, const std::vector<std::string>& messages) {
  std::string bytes;
  for (const std::string& message : messages) {
    daemon::dashboard::append_number(bytes, static_cast<std::uint32_t>(message.size()));
    bytes += message;
  }
  const std::scoped_lock lock{mutex_};
  for (std::size_t written = 0; written < bytes.size();) {
    const ssize_t n =
        ::pwrite(descriptor_, bytes.data() + written, bytes.size() - written, static_cast<off_t>(end_ + written));
    if (n <= 0) fail(folder_, "cannot hold the scans of the run");
    written += static_cast<std::size_t>(n);
  }
  moments_.push_back({time, end_, static_cast<std::uint32_t>(bytes.size())});
  end_ += bytes.size();
}

std::optional<std::string> MomentFile::at(Timestamp time) const {
  const std::scoped_lock lock{mutex_};
  if (moments_.empty()) return std::nullopt;
  auto found = std::upper_bound(moments_.begin(), moments_.end(), time,
                                [](Timestamp wanted, const Moment& moment) { return wanted < moment.time; });
  if (found != moments_.begin()) --found;
  std::string bytes(found->size, '\0');
  for (std::size_t read = 0; read < bytes.size();) {
    const ssize_t n =
        ::pread(descriptor_, bytes.data() + read, bytes.size() - read, static_cast<off_t>(found->begin + read));
    if (n <= 0) fail(folder_, "cannot be read");
    read += static_cast<std::size_t>(n);
  }
  return bytes;
}

MomentFile::Span MomentFile::span() const {
  const std::scoped_lock lock{mutex_};
  if (moments_.empty()) return {};
  return {moments_.size(), moments_.front().time, moments_.back().time};
}

}  // namespace deltamap::tool
