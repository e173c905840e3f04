// SPDX-License-Identifier: Apache-2.0
#include "daemon/maps/map_picture.hpp"

#include <gtest/gtest.h>
#include <png.h>

#include <array>
#include <vector>

#include "tests/support/drawn_grid.hpp"
#include "tests/support/temporary_folder.hpp"

namespace deltamap::tool {
namespace {

using Colour = std::array<std::uint8_t, 3>;

struct Picture {
  unsigned width = 0;
  unsigned height = 0;
  std::vector<std::uint8_t> pixels;
  [[nodiscard]] Colour at(std::size_t x, std::size_t y) const {
    const std::size_t i = (y * width + x) * 3;
    return {pixels[i], pixels[i + 1], pixels[i + 2]};
  }
};

Picture read_picture(const std::filesystem::path& file) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  EXPECT_NE(png_image_begin_read_from_file(&image, file.c_str()), 0);
  image.format = PNG_FORMAT_RGB;
  Picture picture{image.width, image.height, std::vector<std::uint8_t>(PNG_IMAGE_SIZE(image))};
  EXPECT_NE(png_image_finish_read(&image, nullptr, picture.pixels.data(), 0, nullptr), 0);
  return picture;
}

TEST(MapPicture, ColoursWhatHasChangedAndPutsTheHighestRowOnTop) {
  const test::TemporaryFolder folder;
  const OccupancyGrid before = test::drawn_grid({"#.", "##"});
  const OccupancyGrid after = test::drawn_grid({"##", ". "});
  daemon::write_map_picture(before, after, folder.path() / "p.png", {.cell_pixels = 2, .crop_to_known = false});
  const Picture picture = read_picture(folder.path() / "p.png");
  ASSERT_EQ(picture.width, 4u);
  ASSERT_EQ(picture.height, 4u);
  const Colour stays_occupied = picture.at(0, 0);
  const Colour newly_occupied = picture.at(3, 0);
  const Colour newly_free = picture.at(1, 3);
  const Colour forgotten = picture.at(2, 2);
  EXPECT_LT(stays_occupied[0], 50);
  EXPECT_GT(newly_occupied[0], 2 * newly_occupied[1]);
  EXPECT_GT(newly_free[1], newly_free[0]);
  EXPECT_GT(forgotten[2], forgotten[0]);
}

TEST(MapPicture, RefusesMapsOfDifferentSize) {
  const test::TemporaryFolder folder;
  EXPECT_THROW(daemon::write_map_picture(test::drawn_grid({"#"}), test::drawn_grid({"##"}), folder.path() / "p.png"),
               std::runtime_error);
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "p.png"));
}

}  // namespace
}  // namespace deltamap::tool
