// SPDX-License-Identifier: Apache-2.0
// Folders of files in one file, as POSIX ustar (IEEE 1003.1-1988), which every tar reads.
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>

namespace deltamap::tool {

class TarWriter {
 public:
  /// Begins a new file. This and all others throw std::runtime_error naming the file that cannot be read or written.
  explicit TarWriter(std::filesystem::path file);

  /// The plain files in it, as FOLDER/FILE; folders and hidden files are left out.
  void add_folder(const std::filesystem::path& folder);
  /// Marks the end and closes.
  void finish();

 private:
  void add_file(const std::string& name, const std::filesystem::path& file);
  void write(const std::string& bytes);

  std::filesystem::path file_;
  std::ofstream out_;
};

}  // namespace deltamap::tool
