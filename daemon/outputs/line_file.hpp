// SPDX-License-Identifier: Apache-2.0
// Text files that are written line by line. Whatever a disk has no room for, the file ends with a whole line; what did
// not fit waits.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>

#include "daemon/outputs/retrying_output.hpp"

namespace deltamap::daemon {

class LineFile {
 public:
  enum class Begin : std::uint8_t { kNow, kAtFlush };
  /// A new file in the place of an old one. Throws std::runtime_error that names it.
  explicit LineFile(std::filesystem::path file, Begin begin = Begin::kNow);
  /// Writes what waits, without telling whether it could: flush() where that matters.
  ~LineFile();
  LineFile(const LineFile&) = delete;
  LineFile& operator=(const LineFile&) = delete;

  /// Takes a line with its end, and writes now and then. Throws as flush() does.
  void write(const std::string& line);
  /// Takes a line with its end, and writes nothing.
  void add(const std::string& line) { waiting_ += line; }
  /// Everything so far goes to the kernel. Throws std::runtime_error that names the file: then the lines that did not
  /// fit wait for the next flush().
  void flush();

  [[nodiscard]] std::size_t waiting_bytes() const { return waiting_.size(); }
  [[nodiscard]] bool has_begun() const { return descriptor_ >= 0; }

 private:
  void begin();
  /// The file is cut back to its last whole line.
  [[noreturn]] void fail(std::size_t written, int reason);

  std::filesystem::path file_;
  int descriptor_ = -1;
  std::string waiting_;
  std::uint64_t size_bytes_ = 0;  // of whole lines in the file
};

/// Lines of the running daemon: kept for a while where the disk is full (1 MB: twenty minutes of trajectory), then
/// the newest are thrown away and counted.
class LiveLines {
 public:
  LiveLines(const std::filesystem::path& file, RetryingOutput output)
      : file_{file, LineFile::Begin::kAtFlush}, output_{std::move(output)} {}

  void write(const std::string& line, Timestamp now);
  void flush(Timestamp now);
  /// The last attempt.
  void close(Timestamp now);

 private:
  LineFile file_;
  RetryingOutput output_;
};

}  // namespace deltamap::daemon
