// SPDX-License-Identifier: Apache-2.0
// A file that an earlier run has left, whole.
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

namespace deltamap::daemon {

/// Empty where it cannot be read, or is larger than what a run writes.
[[nodiscard]] inline std::string kept_text(const std::filesystem::path& file, std::uintmax_t most_bytes) {
  std::error_code error;
  if (std::filesystem::file_size(file, error) > most_bytes || error) return {};
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace deltamap::daemon
