// SPDX-License-Identifier: Apache-2.0
// A small text file, whole.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace deltamap {

/// Of UTF-8: some editors begin a text with it.
inline constexpr std::string_view kUtf8Mark = "\xEF\xBB\xBF";

/// Its bytes. Throws std::runtime_error with the reason alone ("is a folder", "Permission denied"): the caller knows
/// what the file was wanted for.
[[nodiscard]] std::string text_of_file(const std::filesystem::path& file);

}  // namespace deltamap
