// SPDX-License-Identifier: Apache-2.0
#include "daemon/maps/map_picture.hpp"

#include <png.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <memory>
#include <stdexcept>
#include <system_error>
#include <vector>

#include "core/grid_patch.hpp"

namespace deltamap::daemon {
namespace {

using Colour = std::array<std::uint8_t, 3>;

// Unchanged: free, occupied, unknown; changed: likewise.
constexpr std::array<Colour, 6> kColours{
    {{255, 255, 255}, {24, 26, 30}, {216, 218, 222}, {126, 200, 130}, {214, 40, 40}, {150, 180, 225}}};
constexpr std::size_t kFirstChanged = 3;

std::uint8_t colour_of(CellState before, CellState after) {
  return static_cast<std::uint8_t>(static_cast<std::size_t>(after) + (before == after ? 0 : kFirstChanged));
}

CellBox known_box(const OccupancyGrid& a, const OccupancyGrid& b) {
  return grown(united(deltamap::known_box(a), deltamap::known_box(b)), 4, a.geometry());
}

struct CloseFile {
  void operator()(std::FILE* file) const { (void)std::fclose(file); }
};

/// `pixels` are places in kColours.
std::string png_of(const std::vector<std::uint8_t>& pixels, std::size_t width, std::size_t height) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = static_cast<png_uint_32>(width);
  image.height = static_cast<png_uint_32>(height);
  image.format = PNG_FORMAT_RGB_COLORMAP;
  image.colormap_entries = static_cast<png_uint_32>(kColours.size());
  char* bytes = nullptr;
  std::size_t size = 0;
  std::unique_ptr<std::FILE, CloseFile> memory{::open_memstream(&bytes, &size)};
  if (!memory) throw std::runtime_error(std::generic_category().message(errno));
  const bool is_drawn = png_image_write_to_stdio(&image, memory.get(), 0, pixels.data(), 0, kColours.data()) != 0;
  memory.reset();
  const std::unique_ptr<char, decltype(&std::free)> owner{bytes, &std::free};
  if (!is_drawn) throw std::runtime_error(image.message);
  return {bytes, size};
}

}  // namespace

std::string map_picture(const OccupancyGrid& before, const OccupancyGrid& after, const MapPictureStyle& style) {
  if (!(before.geometry() == after.geometry())) {
    throw std::runtime_error("the two maps differ in size, origin or resolution");
  }
  CellBox box{{0, 0}, {after.width(), after.height()}};
  if (style.crop_to_known && !known_box(before, after).empty()) box = known_box(before, after);
  const auto scale = static_cast<std::size_t>(std::max(1, style.cell_pixels));
  const std::size_t width = static_cast<std::size_t>(box.width()) * scale;
  const std::size_t height = static_cast<std::size_t>(box.height()) * scale;
  std::vector<std::uint8_t> pixels(width * height);
  for (std::size_t y = 0; y < height; ++y) {
    for (std::size_t x = 0; x < width; ++x) {
      const Cell cell{box.first.column + static_cast<int>(x / scale), box.last.row - 1 - static_cast<int>(y / scale)};
      pixels[y * width + x] = colour_of(before[cell], after[cell]);
    }
  }
  return png_of(pixels, width, height);
}

void write_map_picture(const OccupancyGrid& before, const OccupancyGrid& after, const std::filesystem::path& png_file,
                       const MapPictureStyle& style) {
  const auto refuse = [&png_file](const std::string& why) {
    throw std::runtime_error(png_file.string() + ": cannot be written: " + why);
  };
  std::string picture;
  try {
    picture = map_picture(before, after, style);
  } catch (const std::runtime_error& error) {
    refuse(error.what());
  }
  std::ofstream file(png_file, std::ios::binary);
  if (!file || !file.write(picture.data(), static_cast<std::streamsize>(picture.size())).flush()) {
    refuse(std::generic_category().message(errno));
  }
}

}  // namespace deltamap::daemon
