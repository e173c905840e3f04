// SPDX-License-Identifier: Apache-2.0
// Where tests find the project's own files and the recorded data. The checkout's path is known to source_tree.cpp
// alone, so that no other test is compiled anew, or without its precompiled header, because the checkout stands
// elsewhere.
#pragma once

#include <filesystem>
#include <string>

namespace deltamap::test {

/// A file or folder of this checkout, named from its root: `source_path("config/default.yaml")`.
[[nodiscard]] std::string source_path(const std::string& from_root);

/// $DELTAMAP_DATA, by default shared/data beside the checkout. Whether it exists is the caller's question.
[[nodiscard]] std::filesystem::path data_folder();

}  // namespace deltamap::test
