// SPDX-License-Identifier: Apache-2.0
#include "daemon/maps/png_bytes.hpp"

#include <png.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <memory>
#include <stdexcept>
#include <system_error>

namespace deltamap::daemon {
namespace {

struct CloseFile {
  void operator()(std::FILE* file) const { (void)std::fclose(file); }
};

}  // namespace

std::string png_of(std::size_t width, std::size_t height, std::span<const std::uint8_t> pixels,
                   std::span<const std::array<std::uint8_t, 3>> colours) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = static_cast<png_uint_32>(width);
  image.height = static_cast<png_uint_32>(height);
  image.format = colours.empty() ? PNG_FORMAT_RGB : PNG_FORMAT_RGB_COLORMAP;
  image.colormap_entries = static_cast<png_uint_32>(colours.size());
  char* bytes = nullptr;
  std::size_t size = 0;
  std::unique_ptr<std::FILE, CloseFile> memory{::open_memstream(&bytes, &size)};
  if (!memory) throw std::runtime_error(std::generic_category().message(errno));
  const bool is_drawn = png_image_write_to_stdio(&image, memory.get(), 0, pixels.data(), 0,
                                                 colours.empty() ? nullptr : colours.data()) != 0;
  memory.reset();
  const std::unique_ptr<char, decltype(&std::free)> owner{bytes, &std::free};
  if (!is_drawn) throw std::runtime_error(image.message);
  return {bytes, size};
}

void write_bytes(const std::string& bytes, const std::filesystem::path& file) {
  std::ofstream out(file, std::ios::binary);
  if (!out || !out.write(bytes.data(), static_cast<std::streamsize>(bytes.size())).flush()) {
    throw std::runtime_error(file.string() + ": cannot be written: " + std::generic_category().message(errno));
  }
}

}  // namespace deltamap::daemon
