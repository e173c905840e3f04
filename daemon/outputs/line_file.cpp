// SPDX-License-Identifier: Apache-2.0
#include "daemon/outputs/line_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <stdexcept>
#include <system_error>
#include <utility>

namespace deltamap::daemon {
namespace {

constexpr std::size_t kFlushBytes = std::size_t{64} * 1024;
constexpr std::size_t kMostWaitingBytes = std::size_t{1} << 20u;

}  // namespace

LineFile::LineFile(std::filesystem::path file, Begin begin_when) : file_{std::move(file)} {
  if (begin_when == Begin::kNow) begin();
}

LineFile::~LineFile() {
  try {
    if (!waiting_.empty()) flush();
  } catch (const std::runtime_error&) {  // documented: nobody is left to be told
  }
  if (descriptor_ >= 0) ::close(descriptor_);
}

void LineFile::begin() {
  descriptor_ = ::open(file_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_APPEND | O_CLOEXEC, 0644);
  if (descriptor_ < 0) fail(0, errno);
}

void LineFile::write(const std::string& line) {
  add(line);
  if (waiting_.size() >= kFlushBytes) flush();
}

void LineFile::flush() {
  if (descriptor_ < 0) begin();
  std::size_t written = 0;
  while (written < waiting_.size()) {
    const ssize_t n = ::write(descriptor_, waiting_.data() + written, waiting_.size() - written);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) fail(written, n < 0 ? errno : ENOSPC);
    written += static_cast<std::size_t>(n);
  }
  size_bytes_ += written;
  waiting_.clear();
}

void LineFile::fail(std::size_t written, int reason) {
  const std::size_t whole = written == 0 ? 0 : waiting_.rfind('\n', written - 1) + 1;
  size_bytes_ += whole;
  waiting_.erase(0, whole);
  if (descriptor_ >= 0) (void)!::ftruncate(descriptor_, static_cast<off_t>(size_bytes_));
  throw std::runtime_error(file_.string() + ": cannot be written: " + std::generic_category().message(reason));
}

void LiveLines::write(const std::string& line, Timestamp now) {
  if (!output_.works() && file_.waiting_bytes() + line.size() > kMostWaitingBytes) return output_.count_lost();
  file_.add(line);
  if (output_.works() && file_.waiting_bytes() >= kFlushBytes) flush(now);
}

void LiveLines::flush(Timestamp now) {
  if (file_.waiting_bytes() == 0 && file_.has_begun()) return;
  (void)output_.attempt(now, [this] { file_.flush(); });
}

void LiveLines::close(Timestamp now) {
  output_.hurry();
  flush(now);
}

}  // namespace deltamap::daemon
