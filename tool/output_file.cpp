// SPDX-License-Identifier: Apache-2.0
#include "tool/output_file.hpp"

#include <algorithm>
#include <cctype>
#include <stdexcept>
#include <string>
#include <system_error>

#include "core/files/file_lock.hpp"

namespace deltamap::tool {

void require_output_beside(const std::filesystem::path& output, const std::filesystem::path& read) {
  std::error_code not_both_are_there;
  if (std::filesystem::equivalent(output, read, not_both_are_there))
    throw std::runtime_error(output.string() + ": is what is read; give another name");
  if (std::filesystem::exists(output, not_both_are_there)) require_lockable_file(output);
}

void require_png(const std::filesystem::path& output) {
  std::string ending = output.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char letter) { return static_cast<char>(std::tolower(letter)); });
  if (ending != ".png")
    throw std::runtime_error(output.string() + ": only PNG is written; give a name that ends in .png");
}

}  // namespace deltamap::tool
