// SPDX-License-Identifier: Apache-2.0
// A PNG in memory.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

namespace deltamap::daemon {

/// `pixels` row by row from the top: red, green, blue, or, where there are `colours`, the place of a pixel's colour in
/// them. Throws std::runtime_error where that cannot be encoded.
[[nodiscard]] std::string png_of(std::size_t width, std::size_t height, std::span<const std::uint8_t> pixels,
                                 std::span<const std::array<std::uint8_t, 3>> colours = {});

/// Throws std::runtime_error naming the file.
void write_bytes(const std::string& bytes, const std::filesystem::path& file);

}  // namespace deltamap::daemon
