// SPDX-License-Identifier: Apache-2.0
// Puts a text in the place of another one that must not be lost: what people have written stays beside it.
#pragma once

#include <filesystem>
#include <string_view>

#include "core/time.hpp"

namespace deltamap {

/// Replaces what stands in a file, behind links, by `text`, and keeps `before`, which stands there now, beside it under
/// a name that is new: "zones.20261130T110000Z.yaml", which is answered; both whole. Throws std::system_error that
/// names the file: then all is as it was.
std::filesystem::path replace_and_keep(const std::filesystem::path& file, std::string_view before,
                                       std::string_view text, Timestamp now);

}  // namespace deltamap
