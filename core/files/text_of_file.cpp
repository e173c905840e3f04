// SPDX-License-Identifier: Apache-2.0
#include "core/files/text_of_file.hpp"

#include <cerrno>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <system_error>

namespace deltamap {

std::string text_of_file(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  const int reason = errno;
  std::error_code told_by_reason;
  if (std::filesystem::is_directory(file, told_by_reason)) throw std::runtime_error("is a folder");
  if (!in) throw std::runtime_error(std::generic_category().message(reason));
  return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace deltamap
