// SPDX-License-Identifier: Apache-2.0
// PNG pictures of any kind, as a test needs them.
#pragma once

#include <png.h>

#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

namespace deltamap::test {

struct PngPicture {
  int width = 1;
  int height = 1;
  int colour_type = PNG_COLOR_TYPE_GRAY;
  int depth = 8;
  bool is_interlaced = false;
  std::vector<png_color> palette{};
  std::vector<std::uint8_t> palette_alpha{};
  std::vector<std::vector<std::uint8_t>> rows{};  ///< packed, from the top
};

[[nodiscard]] inline std::string png_bytes(PngPicture picture) {
  std::string bytes;
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(png);
  const auto take = [](png_structp from, png_bytep data, std::size_t size) {
    static_cast<std::string*>(png_get_io_ptr(from))->append(reinterpret_cast<const char*>(data), size);
  };
  png_set_write_fn(png, &bytes, take, nullptr);
  png_set_IHDR(png, info, static_cast<png_uint_32>(picture.width), static_cast<png_uint_32>(picture.height),
               picture.depth, picture.colour_type, picture.is_interlaced ? PNG_INTERLACE_ADAM7 : PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  if (!picture.palette.empty())
    png_set_PLTE(png, info, picture.palette.data(), static_cast<int>(picture.palette.size()));
  if (!picture.palette_alpha.empty()) {
    png_set_tRNS(png, info, picture.palette_alpha.data(), static_cast<int>(picture.palette_alpha.size()), nullptr);
  }
  std::vector<png_bytep> rows;
  rows.reserve(picture.rows.size());
  for (std::vector<std::uint8_t>& row : picture.rows) rows.push_back(row.data());
  png_write_info(png, info);
  png_write_image(png, rows.data());
  png_write_end(png, nullptr);
  png_destroy_write_struct(&png, &info);
  return bytes;
}

}  // namespace deltamap::test
