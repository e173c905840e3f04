// SPDX-License-Identifier: Apache-2.0
#include "tests/support/files/source_tree.hpp"

#include <cstdlib>

namespace deltamap::test {

std::string source_path(const std::string& from_root) { return DELTAMAP_SOURCE_DIR "/" + from_root; }

std::filesystem::path data_folder() {
  const char* const configured = std::getenv("DELTAMAP_DATA");  // NOLINT(concurrency-mt-unsafe): nobody sets it
  return configured != nullptr ? configured : source_path("../shared/data");
}

}  // namespace deltamap::test
