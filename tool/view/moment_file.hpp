// SPDX-License-Identifier: Apache-2.0
// What the page is sent of each scan of a run, found by time. It lies in a file without a name, so that a day's scans
// cost no memory, and are gone with the program. Any thread.
#pragma once

#include <cstdint>
#include <filesystem>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "core/time.hpp"

namespace deltamap::tool {

class MomentFile {
 public:
  /// Throws std::system_error naming the folder.
  explicit MomentFile(const std::filesystem::path& folder);
  ~MomentFile();
  MomentFile(const MomentFile&) = delete;
  MomentFile& operator=(const MomentFile&) = delete;

  /// The messages of one scan; times never step back. Throws std::system_error naming the folder: it is full.
  void add(Timestamp time, const std::vector<std::string>& messages);
  /// Messages that belong to every scan from the next one on, in place of those before. Throws as add() does.
  void add_lasting(const std::vector<std::string>& messages);

  /// The messages of the newest scan that is not younger than `time`, else of the first one, and those that last: each
  /// after the number of its bytes as `u32`, little-endian. Nothing where there is no scan.
  [[nodiscard]] std::optional<std::string> at(Timestamp time) const;

  struct Span {
    std::size_t scans = 0;
    Timestamp from, to;  ///< of the first and the last scan
  };
  [[nodiscard]] Span span() const;

 private:
  struct Place {
    std::uint64_t begin = 0;
    std::uint32_t size = 0;
  };
  struct Moment {
    Timestamp time;
    Place own, lasting;
  };
  [[nodiscard]] Place written(const std::vector<std::string>& messages);
  void append(const Place& place, std::string& bytes) const;

  std::filesystem::path folder_;
  int descriptor_;
  mutable std::mutex mutex_;
  std::vector<Moment> moments_;
  Place lasting_;
  std::uint64_t end_ = 0;
};

}  // namespace deltamap::tool
