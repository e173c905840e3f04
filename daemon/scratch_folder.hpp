// SPDX-License-Identifier: Apache-2.0
// A folder in the system's place for temporary files that goes with its owner.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <string>

namespace deltamap::daemon {

class ScratchFolder {
 public:
  /// Throws std::runtime_error where none can be made.
  ScratchFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "deltamap-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) throw std::runtime_error(name + ": no temporary folder can be made");
    path_ = name;
  }
  ~ScratchFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace deltamap::daemon
