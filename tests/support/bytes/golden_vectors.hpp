// SPDX-License-Identifier: Apache-2.0
// The frames that several independent programs agree on, from the shared data (DELTAMAP_DATA).
#pragma once

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>

#include "tests/support/files/source_tree.hpp"

namespace deltamap::tests {

/// nullopt where the data is missing: tests then skip and say so.
[[nodiscard]] inline std::optional<nlohmann::json> golden_vectors() {
  std::ifstream file{test::data_folder() / "golden_vectors.json"};
  if (!file) return std::nullopt;
  return nlohmann::json::parse(file);
}

}  // namespace deltamap::tests

/// Declares `name` with the vectors, or skips the test loudly.
#define DELTAMAP_GOLDEN_VECTORS_OR_SKIP(name)                                                         \
  const auto name##_or_none = deltamap::tests::golden_vectors();                                      \
  if (!name##_or_none) GTEST_SKIP() << "no golden_vectors.json in " << deltamap::test::data_folder(); \
  const nlohmann::json& name = *name##_or_none
