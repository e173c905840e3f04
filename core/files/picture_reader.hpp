// SPDX-License-Identifier: Apache-2.0
// A grey picture on disk, read row by row from the top: PGM (binary or text, 8 or 16 bit) or PNG of any kind.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace deltamap {

using Shade = std::uint32_t;  ///< 0 black to brightest(); brightest() + 1: transparent

inline constexpr int kMaxPictureSide = 32767;  // pixels; 16-bit indices suffice everywhere

class PictureReader {
 public:
  virtual ~PictureReader() = default;
  PictureReader(const PictureReader&) = delete;
  PictureReader& operator=(const PictureReader&) = delete;

  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int height() const { return height_; }
  [[nodiscard]] Shade brightest() const { return brightest_; }
  [[nodiscard]] Shade transparent() const { return brightest_ + 1; }
  /// The next row, from the top; `row` is as long as the picture is wide. Throws std::runtime_error naming the file.
  virtual void read_row(std::span<Shade> row) = 0;
  /// After the last row: what was taken for something else than it says, one line each, that begins with the file.
  [[nodiscard]] virtual std::vector<std::string> notes() const = 0;

 protected:
  PictureReader() = default;
  int width_ = 0;
  int height_ = 0;
  Shade brightest_ = 0;
};

/// Reads the head of a picture. Throws std::runtime_error: one line that names the file and, where there is one, the
/// byte; files of other kinds by what they are.
[[nodiscard]] std::unique_ptr<PictureReader> open_picture(const std::filesystem::path& file);

}  // namespace deltamap
