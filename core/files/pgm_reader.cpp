// SPDX-License-Identifier: Apache-2.0
#include "core/files/pgm_reader.hpp"

#include <algorithm>
#include <cctype>
#include <fstream>
#include <stdexcept>

#include "core/counted.hpp"

namespace deltamap {
namespace {

constexpr int kMostShades = 65535;
constexpr int kEnd = std::char_traits<char>::eof();

/// The header's numbers, separated by white space and comments; then rows of pixels.
class PgmReader final : public PictureReader {
 public:
  explicit PgmReader(const std::filesystem::path& file) : file_{file}, in_(file, std::ios::binary) {
    size_ = static_cast<std::size_t>(std::filesystem::file_size(file));
    (void)in_.get();
    is_text_ = in_.get() == '2';
    width_ = next_number(1, kMaxPictureSide);
    height_ = next_number(1, kMaxPictureSide);
    const int brightest = next_number(1, kMostShades);
    brightest_ = static_cast<Shade>(brightest);
    bytes_of_pixel_ = brightest > 255 ? 2 : 1;
    if (!is_text_) begin_pixels();
  }

  void read_row(std::span<Shade> row) override {
    if (is_text_) return read_text(row);
    bytes_.resize(row.size() * bytes_of_pixel_);
    if (!in_.read(bytes_.data(), static_cast<std::streamsize>(bytes_.size()))) refuse("cannot be read to its end");
    const auto byte = [&](std::size_t i) { return static_cast<Shade>(static_cast<unsigned char>(bytes_[i])); };
    for (std::size_t i = 0; i < row.size(); ++i)
      row[i] = limited(bytes_of_pixel_ == 1 ? byte(i) : (byte(2 * i) << 8U) + byte(2 * i + 1));
  }

  [[nodiscard]] std::vector<std::string> notes() const override {
    std::vector<std::string> notes;
    if (too_bright_ > 0) {
      notes.push_back(file_.string() + ": " + counted(too_bright_, "pixel is", "pixels are") +
                      " brighter than the header's " + std::to_string(brightest_) + ": taken for that");
    }
    if (surplus_bytes_ > 1) {  // one: a line feed at the end
      notes.push_back(file_.string() + ": " + counted(surplus_bytes_, "byte lies", "bytes lie") +
                      " behind the last of " + std::to_string(width_) + " x " + std::to_string(height_) +
                      " pixels and are left out: are width and height right?");
    }
    return notes;
  }

 private:
  [[noreturn]] void refuse(const std::string& why) const { throw std::runtime_error(file_.string() + ": " + why); }
  [[noreturn]] void refuse_at(std::size_t byte, const std::string& why) const {
    refuse("byte " + std::to_string(byte) + ": " + why);
  }

  Shade limited(Shade shade) {
    if (shade <= brightest_) return shade;
    ++too_bright_;
    return brightest_;
  }

  int take() {
    ++at_;
    return in_.get();
  }
  void skip_space() {
    while (in_.peek() == '#' || std::isspace(in_.peek()) != 0) {
      const bool is_comment = in_.peek() == '#';
      do {
        const int byte = take();
        if (!is_text_ && byte == '\r' && in_.peek() == '\n') refuse_changed_line_ends(at_ - 1);
      } while (is_comment && in_.peek() != '\n' && in_.peek() != kEnd);
    }
  }
  [[noreturn]] void refuse_changed_line_ends(std::size_t byte) const {
    refuse_at(byte,
              "header lines end in CR LF: the picture was changed on its way, as git and ftp change text; get it anew "
              "as binary");
  }
  int next_number(int least, int most) {
    skip_space();
    const std::size_t start = at_;
    long value = 0;
    while (std::isdigit(in_.peek()) != 0 && value <= most) value = value * 10 + (take() - '0');
    if (at_ != start && value >= least && value <= most) return static_cast<int>(value);
    refuse_at(start, "expected a number from " + std::to_string(least) + " to " + std::to_string(most));
  }

  /// Pixels begin after exactly one white space; refuses a file that has too few.
  void begin_pixels() {
    if (take() == '\r' && in_.peek() == '\n') refuse_changed_line_ends(at_ - 1);
    const auto pixels = static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_);
    const std::size_t needed = at_ + pixels * bytes_of_pixel_;
    if (size_ < needed) refuse_cut(std::to_string(needed) + " bytes");
    surplus_bytes_ = size_ - needed;
  }
  [[noreturn]] void refuse_cut(const std::string& needed) const {
    refuse_at(size_,
              "cut short, " + std::to_string(width_) + " x " + std::to_string(height_) + " cells need " + needed);
  }

  void read_text(std::span<Shade> row) {
    for (Shade& shade : row) {
      skip_space();
      if (in_.peek() == kEnd) refuse_cut("as many numbers");
      shade = limited(static_cast<Shade>(next_number(0, kMostShades)));
    }
    if (++rows_ < height_) return;
    skip_space();
    surplus_bytes_ = size_ - std::min(size_, at_) + (in_.peek() == kEnd ? 0 : 1);
  }

  std::filesystem::path file_;
  std::ifstream in_;
  std::size_t size_ = 0;
  std::size_t at_ = 2;
  bool is_text_ = false;
  std::size_t bytes_of_pixel_ = 1;
  std::string bytes_;
  int rows_ = 0;
  std::uint64_t too_bright_ = 0;
  std::uint64_t surplus_bytes_ = 0;
};

}  // namespace

std::unique_ptr<PictureReader> open_pgm(const std::filesystem::path& file) { return std::make_unique<PgmReader>(file); }

}  // namespace deltamap
