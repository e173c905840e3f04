// SPDX-License-Identifier: Apache-2.0
// The fields of a frame as people and programs read them.
#pragma once

#include <cstddef>
#include <string>

#include "tool/decode/decoded_frame.hpp"

namespace deltamap::tool {

/// A JSON object, in one line.
[[nodiscard]] std::string json_of(const NamedFields& fields);

/// "  name: value", a line each. Of a list that is longer than `longest_list` the beginning, and how many there are; of
/// a text that is longer than 200 characters, too.
[[nodiscard]] std::string text_of(const NamedFields& fields, std::size_t longest_list);

}  // namespace deltamap::tool
