// SPDX-License-Identifier: Apache-2.0
// The runs that are done, a line each, in a file that is appended to whole lines at a time: whatever ends the program
// leaves every run that had ended, and the same command goes on from there.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include "core/files/file_lock.hpp"
#include "tool/tune/measured_run.hpp"

namespace deltamap::tool::tune {

class RunBook {
 public:
  /// Opens DIR/runs.jsonl, or begins it; `header` is a JSON object that tells what all its runs have in common. A last
  /// line that was cut is left out. Throws std::runtime_error where the file was begun under another header, naming
  /// what differs, FileInUse where another program writes there. `anew`: what is there goes.
  RunBook(const std::filesystem::path& folder, const std::string& header, bool anew);
  ~RunBook();
  RunBook(const RunBook&) = delete;
  RunBook& operator=(const RunBook&) = delete;

  /// Nothing where it is not done yet. `key` names drive, settings and seed; `poses` are not kept.
  [[nodiscard]] std::optional<MeasuredRun> run(const std::string& key) const;
  /// One call at a time. Throws std::runtime_error where the disk is full.
  void add(const std::string& key, const MeasuredRun& run);

  [[nodiscard]] std::size_t size() const { return runs_.size(); }

 private:
  void read(const std::string& content, const std::string& header);
  void append(const std::string& line);

  std::filesystem::path file_;
  std::optional<FileLock> lock_;
  int descriptor_ = -1;
  std::map<std::string, MeasuredRun> runs_;
};

}  // namespace deltamap::tool::tune
