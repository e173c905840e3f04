// SPDX-License-Identifier: Apache-2.0
// Portable graymaps: binary (P5) and text (P2), 8 and 16 bit.
#pragma once

#include "core/files/picture_reader.hpp"

namespace deltamap {

/// A file that begins with P5 or P2. Throws as open_picture().
[[nodiscard]] std::unique_ptr<PictureReader> open_pgm(const std::filesystem::path& file);

}  // namespace deltamap
