// SPDX-License-Identifier: Apache-2.0
// Files that are given in place of a map, its picture or a log, by their first bytes: what each is, and what to do.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

namespace deltamap {

/// So many bytes of a file are enough to know it.
inline constexpr std::size_t kTellingBytes = 4096;

enum class WantedFile { kMap, kLog };

/// "is a map of ARIA…, not a log", as it stands behind a file's name, and what to do instead; "" for what is none of
/// the kinds known here.
[[nodiscard]] std::string foreign_kind(const std::filesystem::path& file, std::string_view first_bytes,
                                       WantedFile wanted);

}  // namespace deltamap
