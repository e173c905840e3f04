// SPDX-License-Identifier: Apache-2.0
#include "tool/picture/animated_png.hpp"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <stdexcept>

#include "daemon/maps/png_bytes.hpp"

namespace deltamap::tool::picture {
namespace {

constexpr std::size_t kSignature = 8;   // bytes before the first chunk
constexpr std::size_t kFrameless = 12;  // of a chunk: length, name, checksum

void append_u32(std::string& bytes, std::uint32_t number) {
  for (const int shift : {24, 16, 8, 0}) bytes.push_back(static_cast<char>(number >> shift & 0xFFU));
}

std::uint32_t u32_at(const std::string& bytes, std::size_t at) {
  std::uint32_t number = 0;
  for (std::size_t i = 0; i < 4; ++i) number = number << 8 | static_cast<unsigned char>(bytes.at(at + i));
  return number;
}

/// CRC-32 of ISO 3309, as PNG has it.
std::uint32_t checksum(const std::string& bytes) {
  std::uint32_t sum = 0xFFFFFFFFU;
  for (const char byte : bytes) {
    sum ^= static_cast<unsigned char>(byte);
    for (int bit = 0; bit < 8; ++bit) sum = sum >> 1 ^ ((sum & 1U) != 0 ? 0xEDB88320U : 0U);
  }
  return ~sum;
}

void append_chunk(std::string& file, const std::string& name, const std::string& data) {
  append_u32(file, static_cast<std::uint32_t>(data.size()));
  const std::string body = name + data;
  file += body;
  append_u32(file, checksum(body));
}

/// The data of all chunks of a name, joined.
std::string data_of(const std::string& png, const std::string& name) {
  std::string data;
  for (std::size_t at = kSignature; at + kFrameless <= png.size(); at += kFrameless + u32_at(png, at)) {
    if (png.compare(at + 4, 4, name) == 0) data += png.substr(at + 8, u32_at(png, at));
  }
  return data;
}

struct Box {
  std::size_t left, top, width, height;
};

/// What differs; one pixel where nothing does: a frame may not be empty.
Box differing(const Raster& a, const Raster& b) {
  std::size_t left = b.width, right = 0, top = b.height, bottom = 0;
  for (std::size_t y = 0; y < b.height; ++y) {
    for (std::size_t x = 0; x < b.width; ++x) {
      const std::size_t at = 3 * (y * b.width + x);
      if (std::memcmp(&a.rgb[at], &b.rgb[at], 3) == 0) continue;
      left = std::min(left, x);
      right = std::max(right, x + 1);
      top = std::min(top, y);
      bottom = std::max(bottom, y + 1);
    }
  }
  if (right == 0) return {0, 0, 1, 1};
  return {left, top, right - left, bottom - top};
}

Raster cut(const Raster& whole, const Box& box) {
  Raster part{box.width, box.height, {}};
  for (std::size_t y = 0; y < box.height; ++y) {
    const auto from = whole.rgb.begin() + static_cast<std::ptrdiff_t>(3 * ((box.top + y) * whole.width + box.left));
    part.rgb.insert(part.rgb.end(), from, from + static_cast<std::ptrdiff_t>(3 * box.width));
  }
  return part;
}

std::string control(std::uint32_t sequence, const Box& box, int shown_ms) {
  std::string data;
  append_u32(data, sequence);
  for (const std::size_t number : {box.width, box.height, box.left, box.top}) {
    append_u32(data, static_cast<std::uint32_t>(number));
  }
  const auto ms = static_cast<std::uint16_t>(std::clamp(shown_ms, 1, 65535));
  for (const int shift : {8, 0}) data.push_back(static_cast<char>(ms >> shift & 0xFF));
  data += std::string{"\x03\xE8", 2};  // of a second: 1000
  data += std::string(2, '\0');        // leave it there; put it in place of what was
  return data;
}

}  // namespace

std::string animated_png(const std::vector<Frame>& frames) {
  if (frames.empty()) throw std::runtime_error("an animated picture needs a frame");
  const Raster& first = frames.front().raster;
  const std::string still = daemon::png_of(first.width, first.height, first.rgb);
  std::string file = still.substr(0, kSignature);
  append_chunk(file, "IHDR", data_of(still, "IHDR"));
  std::string count;
  append_u32(count, static_cast<std::uint32_t>(frames.size()));
  append_u32(count, 0);  // again and again
  append_chunk(file, "acTL", count);
  append_chunk(file, "fcTL", control(0, {0, 0, first.width, first.height}, frames.front().shown_ms));
  append_chunk(file, "IDAT", data_of(still, "IDAT"));
  std::uint32_t sequence = 1;
  for (std::size_t i = 1; i < frames.size(); ++i) {
    const Raster& raster = frames[i].raster;
    if (raster.width != first.width || raster.height != first.height) {
      throw std::runtime_error("the frames of an animated picture differ in size");
    }
    const Box box = differing(frames[i - 1].raster, raster);
    append_chunk(file, "fcTL", control(sequence++, box, frames[i].shown_ms));
    const Raster part = cut(raster, box);
    std::string data;
    append_u32(data, sequence++);
    append_chunk(file, "fdAT", data + data_of(daemon::png_of(part.width, part.height, part.rgb), "IDAT"));
  }
  append_chunk(file, "IEND", "");
  return file;
}

}  // namespace deltamap::tool::picture
