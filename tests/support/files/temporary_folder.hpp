// SPDX-License-Identifier: Apache-2.0
// A folder that lives as long as a test.
#pragma once

#include <fstream>
#include <string>

#include "core/files/scratch_folder.hpp"

namespace deltamap::test {

class TemporaryFolder : public ScratchFolder {
 public:
  std::filesystem::path write(const std::string& name, const std::string& content) const {
    std::ofstream(path() / name, std::ios::binary) << content;
    return path() / name;
  }
};

}  // namespace deltamap::test
