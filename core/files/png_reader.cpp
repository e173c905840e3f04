// SPDX-License-Identifier: Apache-2.0
#include "core/files/png_reader.hpp"

#include <png.h>

#include <algorithm>
#include <cerrno>
#include <csetjmp>
#include <cstdio>
#include <stdexcept>
#include <system_error>

namespace deltamap {
namespace {

constexpr std::size_t kMostInterlaced = 32u << 20;  // bytes: such a picture is whole in memory while it is read

class PngReader final : public PictureReader {
 public:
  explicit PngReader(const std::filesystem::path& file) : name_{file.string()} {
    file_.reset(std::fopen(file.c_str(), "rb"));
    if (!file_) refuse(std::generic_category().message(errno));
    png_.png = png_create_read_struct(PNG_LIBPNG_VER_STRING, this, &PngReader::keep_reason, &PngReader::ignore);
    png_.info = png_.png == nullptr ? nullptr : png_create_info_struct(png_.png);
    if (png_.info == nullptr) refuse("PNG: no memory");
    if (!read_head()) refuse_broken();
    if (is_interlaced_ && bytes_of_row_ * static_cast<std::size_t>(height_) > kMostInterlaced)
      refuse("PNG: is interlaced and too large for that: save it without interlacing");
    const bool is_colour = channels_ >= 3;
    most_ = depth_ == 16 ? 65535 : 255;
    brightest_ = is_colour ? 3 * most_ : most_;
    bytes_.resize(is_interlaced_ ? bytes_of_row_ * static_cast<std::size_t>(height_) : bytes_of_row_);
    if (is_interlaced_ && !read_all()) refuse_broken();
  }

  void read_row(std::span<Shade> row) override {
    if (!is_interlaced_ && !read_bytes()) refuse_broken();
    const std::uint8_t* bytes = bytes_.data() + (is_interlaced_ ? bytes_of_row_ * next_row_ : 0);
    for (std::size_t i = 0; i < row.size(); ++i) row[i] = shade_of(bytes, i);
    if (++next_row_ == static_cast<std::size_t>(height_) && !read_end()) refuse_broken();
  }

  [[nodiscard]] std::vector<std::string> notes() const override {
    std::vector<std::string> notes;
    if (coloured_ > 0) {
      notes.push_back(name_ + ": " + std::to_string(coloured_) +
                      " pixels are coloured: the mean of red, green and blue counts");
    }
    if (half_transparent_ > 0) {
      notes.push_back(name_ + ": " + std::to_string(half_transparent_) +
                      " pixels are half transparent: their shade counts; only alpha 0 is unknown");
    }
    return notes;
  }

 private:
  struct CloseFile {
    void operator()(std::FILE* file) const { (void)std::fclose(file); }
  };
  struct Png {
    Png() = default;
    ~Png() { png_destroy_read_struct(&png, &info, nullptr); }
    Png(const Png&) = delete;
    Png& operator=(const Png&) = delete;
    png_structp png = nullptr;
    png_infop info = nullptr;
  };

  [[noreturn]] void refuse(const std::string& why) const { throw std::runtime_error(name_ + ": " + why); }
  [[noreturn]] void refuse_broken() const {
    refuse("PNG: " + reason_ + ", before byte " + std::to_string(std::max(0L, std::ftell(file_.get()))));
  }

  // The library tells an error by a jump: the functions that call it hold nothing that must be destroyed.
  // NOLINTBEGIN(cert-err52-cpp)
  static void keep_reason(png_structp png, png_const_charp why) {
    static_cast<PngReader*>(png_get_error_ptr(png))->reason_ = why;
    png_longjmp(png, 1);
  }
  static void ignore(png_structp, png_const_charp) {}

  bool read_head() {
    if (setjmp(png_jmpbuf(png_.png)) != 0) return false;
    png_init_io(png_.png, file_.get());
    png_set_user_limits(png_.png, kMaxPictureSide, kMaxPictureSide);
    png_read_info(png_.png, png_.info);
    width_ = static_cast<int>(png_get_image_width(png_.png, png_.info));
    height_ = static_cast<int>(png_get_image_height(png_.png, png_.info));
    png_set_expand(png_.png);  // palettes to colours, 1 to 4 bit to 8, a transparent colour to alpha
    is_interlaced_ = png_set_interlace_handling(png_.png) > 1;
    png_read_update_info(png_.png, png_.info);
    depth_ = png_get_bit_depth(png_.png, png_.info);
    channels_ = png_get_channels(png_.png, png_.info);
    bytes_of_row_ = png_get_rowbytes(png_.png, png_.info);
    return true;
  }
  bool read_bytes() {
    if (setjmp(png_jmpbuf(png_.png)) != 0) return false;
    png_read_row(png_.png, bytes_.data(), nullptr);
    return true;
  }
  /// An interlaced picture comes in seven passes, each of which adds pixels to the rows.
  bool read_all() {
    if (setjmp(png_jmpbuf(png_.png)) != 0) return false;
    for (int pass = 0; pass < 7; ++pass) {
      for (std::size_t row = 0; row < static_cast<std::size_t>(height_); ++row)
        png_read_row(png_.png, bytes_.data() + row * bytes_of_row_, nullptr);
    }
    return true;
  }
  bool read_end() {
    if (setjmp(png_jmpbuf(png_.png)) != 0) return false;
    png_read_end(png_.png, nullptr);
    return true;
  }
  // NOLINTEND(cert-err52-cpp)

  Shade shade_of(const std::uint8_t* row, std::size_t column) {
    const auto sample = [&](std::size_t channel) -> Shade {
      const std::size_t at = column * channels_ + channel;
      return depth_ == 16 ? (Shade{row[2 * at]} << 8U) + row[2 * at + 1] : row[at];
    };
    if (channels_ % 2 == 0) {
      const Shade alpha = sample(channels_ - 1);
      if (alpha == 0) return transparent();
      half_transparent_ += alpha < most_ ? 1 : 0;
    }
    if (channels_ < 3) return sample(0);
    const auto [darkest, lightest] = std::minmax({sample(0), sample(1), sample(2)});
    coloured_ += lightest - darkest > most_ / 16 ? 1 : 0;  // less is grey, as a camera or a JPEG leaves it
    return sample(0) + sample(1) + sample(2);
  }

  std::string name_;
  std::unique_ptr<std::FILE, CloseFile> file_;
  Png png_;
  std::string reason_;
  int depth_ = 8;
  std::size_t channels_ = 1;
  std::size_t bytes_of_row_ = 0;
  bool is_interlaced_ = false;
  Shade most_ = 255;  // of one channel
  std::vector<std::uint8_t> bytes_;
  std::size_t next_row_ = 0;
  std::uint64_t coloured_ = 0;
  std::uint64_t half_transparent_ = 0;
};

}  // namespace

std::unique_ptr<PictureReader> open_png(const std::filesystem::path& file) { return std::make_unique<PngReader>(file); }

}  // namespace deltamap
