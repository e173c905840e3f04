// SPDX-License-Identifier: Apache-2.0
// YAML that people write: read whole, and its mistakes in words for whoever wrote it.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace YAML {  // NOLINT(readability-identifier-naming): theirs
class Exception;
class Node;
}  // namespace YAML

namespace deltamap {

/// The one tree of a text. YAML::Load (yaml-cpp 0.7.0) reads up to where a text leaves its first tree and says nothing
/// of the rest: a second document, or keys that stand further left than the first; and it ends a quote that is not
/// closed at the end of the text, with all that it swallowed. Throws YAML::Exception, for these too: each quote closes
/// on its line.
[[nodiscard]] YAML::Node only_yaml_tree(const std::string& text);

/// The index behind the quote that closes the one at `opening`; nullopt where the line has none.
[[nodiscard]] std::optional<std::size_t> end_of_quoted(std::string_view line, std::size_t opening);

/// "not YAML: a '[' is not closed"
[[nodiscard]] std::string meaning_of(const YAML::Exception& error);

/// The same with its line, from 1: "line 3: not YAML: …". What is missing at the end is missing in the last line.
[[nodiscard]] std::string placed_meaning_of(const YAML::Exception& error, const std::string& text);

}  // namespace deltamap
