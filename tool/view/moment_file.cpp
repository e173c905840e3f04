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

MomentFile::Place MomentFile::written(const std::vector<std::string>& messages) {
  std::string bytes;
  for (const std::string& message : messages) {
    daemon::dashboard::append_number(bytes, static_cast<std::uint32_t>(message.size()));
    bytes += message;
  }
  for (std::size_t done = 0; done < bytes.size();) {
    const ssize_t n = ::pwrite(descriptor_, bytes.data() + done, bytes.size() - done, static_cast<off_t>(end_ + done));
    if (n <= 0) fail(folder_, "cannot hold the scans of the run");
    done += static_cast<std::size_t>(n);
  }
  const Place place{end_, static_cast<std::uint32_t>(bytes.size())};
  end_ += bytes.size();
  return place;
}

void MomentFile::add(Timestamp time, const std::vector<std::string>& messages) {
  const std::scoped_lock lock{mutex_};
  moments_.push_back({time, written(messages), lasting_});
}

void MomentFile::add_lasting(const std::vector<std::string>& messages) {
  const std::scoped_lock lock{mutex_};
  lasting_ = written(messages);
}

void MomentFile::append(const Place& place, std::string& bytes) const {
  const std::size_t before = bytes.size();
  bytes.resize(before + place.size);
  for (std::size_t done = 0; done < place.size;) {
    const ssize_t n =
        ::pread(descriptor_, bytes.data() + before + done, place.size - done, static_cast<off_t>(place.begin + done));
    if (n <= 0) fail(folder_, "cannot be read");
    done += static_cast<std::size_t>(n);
  }
}

std::optional<std::string> MomentFile::at(Timestamp time) const {
  const std::scoped_lock lock{mutex_};
  if (moments_.empty()) return std::nullopt;
  auto found = std::upper_bound(moments_.begin(), moments_.end(), time,
                                [](Timestamp wanted, const Moment& moment) { return wanted < moment.time; });
  if (found != moments_.begin()) --found;
  std::string bytes;
  append(found->own, bytes);
  append(found->lasting, bytes);
  return bytes;
}

MomentFile::Span MomentFile::span() const {
  const std::scoped_lock lock{mutex_};
  if (moments_.empty()) return {};
  return {moments_.size(), moments_.front().time, moments_.back().time};
}

}  // namespace deltamap::tool
