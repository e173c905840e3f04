// SPDX-License-Identifier: Apache-2.0
#include "daemon/tool/map_picture.hpp"

#include <png.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <memory>
#include <stdexcept>
#include <vector>

#include "core/grid_file.hpp"
#include "core/grid_patch.hpp"
#include "daemon/tool/subcommands.hpp"

namespace deltamap::daemon::tool {
namespace {

using Colour = std::array<std::uint8_t, 3>;

constexpr Colour kWhite{255, 255, 255};
constexpr Colour kGrey{216, 218, 222};
constexpr Colour kBlack{24, 26, 30};
constexpr Colour kRed{214, 40, 40};
constexpr Colour kGreen{126, 200, 130};
constexpr Colour kBlue{150, 180, 225};

Colour colour_of(CellState before, CellState after) {
  const bool changed = before != after;
  switch (after) {
    case CellState::kOccupied:
      return changed ? kRed : kBlack;
    case CellState::kFree:
      return changed ? kGreen : kWhite;
    case CellState::kUnknown:
      break;
  }
  return changed ? kBlue : kGrey;
}

CellBox known_box(const OccupancyGrid& a, const OccupancyGrid& b) {
  return grown(united(deltamap::known_box(a), deltamap::known_box(b)), 4, a.geometry());
}

}  // namespace

void write_map_picture(const OccupancyGrid& before, const OccupancyGrid& after, const std::filesystem::path& png_file,
                       const MapPictureStyle& style) {
  if (!(before.geometry() == after.geometry())) {
    throw std::runtime_error(png_file.string() + ": the two maps differ in size, origin or resolution");
  }
  CellBox box{{0, 0}, {after.width(), after.height()}};
  if (style.crop_to_known && !known_box(before, after).empty()) box = known_box(before, after);
  const auto scale = static_cast<std::size_t>(std::max(1, style.cell_pixels));
  const std::size_t width = static_cast<std::size_t>(box.width()) * scale;
  const std::size_t height = static_cast<std::size_t>(box.height()) * scale;
  std::vector<std::uint8_t> pixels(width * height * 3);
  for (std::size_t y = 0; y < height; ++y) {
    for (std::size_t x = 0; x < width; ++x) {
      const Cell cell{box.first.column + static_cast<int>(x / scale), box.last.row - 1 - static_cast<int>(y / scale)};
      std::ranges::copy(colour_of(before[cell], after[cell]),
                        pixels.begin() + static_cast<std::ptrdiff_t>((y * width + x) * 3));
    }
  }
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = static_cast<png_uint_32>(width);
  image.height = static_cast<png_uint_32>(height);
  image.format = PNG_FORMAT_RGB;
  if (png_image_write_to_file(&image, png_file.c_str(), 0, pixels.data(), 0, nullptr) == 0) {
    throw std::runtime_error(png_file.string() + ": cannot be written: " + image.message);
  }
}

void add_map_picture(CLI::App& map) {
  struct Options {
    std::string map;
    std::string before;
    std::string png;
    int scale = 1;
  };
  auto options = std::make_shared<Options>();
  CLI::App* command = map.add_subcommand("picture", "draw a map as a PNG; with --before, what has changed in colour");
  command->add_option("MAP", options->map, "map_server YAML")->required();
  command->add_option("PNG", options->png, "picture to write")->required();
  command->add_option("--before", options->before, "an earlier map of the same place");
  command->add_option("--scale", options->scale, "pixels a cell")->check(CLI::Range(1, 16));
  command->callback([options] {
    const OccupancyGrid after = read_grid(options->map);
    const OccupancyGrid before = options->before.empty() ? after : read_grid(options->before);
    write_map_picture(before, after, options->png, {.cell_pixels = options->scale});
  });
}

}  // namespace deltamap::daemon::tool
