// SPDX-License-Identifier: Apache-2.0
// PNG pictures of every kind (grey, colour, palette, with alpha, 1 to 16 bit, interlaced), as shades: the mean of red,
// green and blue, as map_server reads them; alpha 0 is transparent.
#pragma once

#include "core/files/picture_reader.hpp"

namespace deltamap {

/// A file that begins as PNG does. Throws as open_picture().
[[nodiscard]] std::unique_ptr<PictureReader> open_png(const std::filesystem::path& file);

}  // namespace deltamap
