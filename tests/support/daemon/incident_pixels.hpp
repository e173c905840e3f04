// SPDX-License-Identifier: Apache-2.0
// The picture of an incident as a test reads it: its pixels, counted by colour.
#pragma once

#include <gtest/gtest.h>
#include <png.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace deltamap::test {

using Colour = std::array<std::uint8_t, 3>;

namespace incident_colours {
inline constexpr Colour kBlack{24, 26, 30};
inline constexpr Colour kGreen{0, 158, 115};
inline constexpr Colour kOrange{213, 94, 0};
inline constexpr Colour kBlue{0, 60, 180};
inline constexpr Colour kPurple{204, 121, 167};
}  // namespace incident_colours

struct Pixels {
  std::size_t side = 0;
  std::vector<Colour> all;
  [[nodiscard]] std::size_t count(const Colour& colour) const {
    return static_cast<std::size_t>(std::count(all.begin(), all.end(), colour));
  }
};

inline Pixels pixels_of(const std::string& png) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  EXPECT_NE(png_image_begin_read_from_memory(&image, png.data(), png.size()), 0) << image.message;
  image.format = PNG_FORMAT_RGB;
  std::vector<std::uint8_t> bytes(PNG_IMAGE_SIZE(image));
  EXPECT_NE(png_image_finish_read(&image, nullptr, bytes.data(), 0, nullptr), 0) << image.message;
  EXPECT_EQ(image.width, image.height);
  Pixels pixels{image.width, {}};
  for (std::size_t i = 0; i + 2 < bytes.size(); i += 3) pixels.all.push_back({bytes[i], bytes[i + 1], bytes[i + 2]});
  return pixels;
}

}  // namespace deltamap::test
