// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>
#include <utility>

namespace deltamap::tool {

/// A file that appears under its name only when it is whole.
class Draft {
 public:
  explicit Draft(std::filesystem::path file) : file_{std::move(file)}, draft_{path_of(file_)} {}
  ~Draft() {
    std::error_code ignored;
    if (!kept_) std::filesystem::remove(draft_, ignored);
  }
  Draft(const Draft&) = delete;
  Draft& operator=(const Draft&) = delete;

  /// Where a file is written until it is whole.
  [[nodiscard]] static std::filesystem::path path_of(const std::filesystem::path& file) {
    return file.string() + ".part";
  }
  [[nodiscard]] const std::filesystem::path& path() const { return draft_; }
  void keep() {
    std::error_code error;
    std::filesystem::rename(draft_, file_, error);
    if (error) throw std::runtime_error(file_.string() + ": cannot be written: " + error.message());
    kept_ = true;
  }

 private:
  std::filesystem::path file_;
  std::filesystem::path draft_;
  bool kept_ = false;
};

}  // namespace deltamap::tool
