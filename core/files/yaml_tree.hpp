// SPDX-License-Identifier: Apache-2.0
// YAML that people write: read whole, and its mistakes in words for whoever wrote it.
#pragma once

#include <string>

namespace YAML {  // NOLINT(readability-identifier-naming): theirs
class Exception;
class Node;
}  // namespace YAML

namespace deltamap {

/// The one tree of a text. YAML::Load (yaml-cpp 0.7.0) reads up to where a text leaves its first tree and says nothing
/// of the rest: a second document, or keys that stand further left than the first. Throws YAML::Exception, for that
/// too.
[[nodiscard]] YAML::Node only_yaml_tree(const std::string& text);

/// "not YAML: a '[' is not closed"
[[nodiscard]] std::string meaning_of(const YAML::Exception& error);

/// The same with its line, from 1: "line 3: not YAML: …". What is missing at the end is missing in the last line.
[[nodiscard]] std::string placed_meaning_of(const YAML::Exception& error, const std::string& text);

}  // namespace deltamap
