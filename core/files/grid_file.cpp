// SPDX-License-Identifier: Apache-2.0
#include "core/files/grid_file.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>
#include <span>
#include <stdexcept>
#include <system_error>
#include <utility>
#include <vector>

#include "core/files/grid_description.hpp"
#include "core/files/replace_file.hpp"
#include "core/files/shortest_text.hpp"
#include "core/files/text_of_file.hpp"
#include "core/grid/tiled.hpp"

namespace deltamap {
namespace {

constexpr int kTogether = Tiled<CellState>::kSide;  // pixels
constexpr int kMaxSide = 32767;                     // cells; 16-bit indices suffice everywhere

[[noreturn]] void refuse(const std::filesystem::path& file, const std::string& why) {
  throw std::runtime_error(file.string() + ": " + why);
}

std::ifstream open_file(const std::filesystem::path& file) {
  std::error_code told_below;
  if (std::filesystem::is_directory(file, told_below)) refuse(file, "is a directory");
  if (std::filesystem::is_other(file, told_below)) refuse(file, "is no plain file");  // a pipe may say nothing for ever
  std::ifstream in(file, std::ios::binary);
  if (!in) refuse(file, std::generic_category().message(errno));
  return in;
}

/// A binary PGM, read from its beginning: the header, numbers separated by white space and comments, then rows of
/// pixels.
class PgmReader {
 public:
  explicit PgmReader(const std::filesystem::path& file) : in_{open_file(file)}, file_{file} {
    if (in_.get() != 'P' || in_.get() != '5') refuse(file, "byte 0: not a binary PGM (P5)");
  }
  int next_number(int most) {
    skip_space();
    const std::size_t start = at_;
    long value = 0;
    while (std::isdigit(in_.peek()) != 0 && value <= most) {
      value = value * 10 + (in_.get() - '0');
      ++at_;
    }
    if (at_ == start || value < 1 || value > most) {
      refuse(file_, "byte " + std::to_string(start) + ": expected a number from 1 to " + std::to_string(most));
    }
    return static_cast<int>(value);
  }
  /// Pixels begin after exactly one white space; refuses a file that has too few.
  void begin_pixels(int width, int height) {
    (void)in_.get();
    const auto needed = at_ + 1 + static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    const auto size = static_cast<std::size_t>(std::filesystem::file_size(file_));
    if (size >= needed) return;
    refuse(file_, "byte " + std::to_string(size) + ": cut short, " + std::to_string(width) + " x " +
                      std::to_string(height) + " cells need " + std::to_string(needed) + " bytes");
  }
  void read_row(std::string& row) {
    if (!in_.read(row.data(), static_cast<std::streamsize>(row.size()))) refuse(file_, "cannot be read to its end");
  }

 private:
  void skip_space() {
    while (in_.peek() == '#' || std::isspace(in_.peek()) != 0) {
      const bool is_comment = in_.peek() == '#';
      do {
        (void)in_.get();
        ++at_;
      } while (is_comment && in_.peek() != '\n' && in_.peek() != std::char_traits<char>::eof());
    }
  }
  std::ifstream in_;
  const std::filesystem::path& file_;
  std::size_t at_ = 2;
};

CellState state_of(double darkness, const GridDescription& keys) {
  if (darkness > keys.occupied_threshold) return CellState::kOccupied;
  return darkness < keys.free_threshold ? CellState::kFree : CellState::kUnknown;
}

using CellStates = std::array<CellState, 256>;

CellStates cell_states(int brightest, const GridDescription& keys) {
  CellStates states{};
  for (int shade = 0; shade < 256; ++shade) {
    const double light = static_cast<double>(std::min(shade, brightest)) / brightest;
    states[static_cast<std::size_t>(shade)] = state_of(keys.negate ? light : 1.0 - light, keys);
  }
  return states;
}

bool is_of_one_shade(std::string_view pixels) {
  return std::memcmp(pixels.data(), pixels.data() + 1, pixels.size() - 1) == 0;
}

/// Both files of a map, read from the beginning.
class MapFiles {
 public:
  explicit MapFiles(const std::filesystem::path& yaml_file)
      : keys_{read_grid_description(yaml_file)},
        image_{yaml_file.parent_path() / keys_.image},  // an absolute image path stands for itself
        pgm_{image_} {
    const int width = pgm_.next_number(kMaxSide);
    const int height = pgm_.next_number(kMaxSide);
    brightest_ = pgm_.next_number(255);
    pgm_.begin_pixels(width, height);
    geometry_ = {width, height, keys_.resolution_m, keys_.origin};
  }
  MapFiles(const MapFiles&) = delete;
  MapFiles& operator=(const MapFiles&) = delete;

  [[nodiscard]] const GridDescription& keys() const { return keys_; }
  [[nodiscard]] const GridGeometry& geometry() const { return geometry_; }
  [[nodiscard]] CellStates states() const { return cell_states(brightest_, keys_); }

  /// Once: `visit(Cell first, std::string_view shades)` for the pieces of rows in which something is known, from the
  /// top. A piece lies in one column of tiles.
  template <typename Visit>
  void visit_shown(Visit&& visit) {
    const CellStates states = this->states();
    std::string shades(static_cast<std::size_t>(geometry_.width), '\0');
    for (int row = geometry_.height - 1; row >= 0; --row) {
      pgm_.read_row(shades);
      for (int column = 0; column < geometry_.width; column += kTogether) {
        const std::string_view piece = std::string_view{shades}.substr(static_cast<std::size_t>(column), kTogether);
        const CellState first = states[static_cast<unsigned char>(piece.front())];
        if (first == CellState::kUnknown && is_of_one_shade(piece)) continue;  // most of a large map
        visit({column, row}, piece);
      }
    }
  }

 private:
  GridDescription keys_;
  std::filesystem::path image_;
  PgmReader pgm_;
  int brightest_ = 255;
  GridGeometry geometry_;
};

char shade_of(CellState state) {
  switch (state) {
    case CellState::kOccupied:
      return static_cast<char>(0);
    case CellState::kFree:
      return static_cast<char>(254);
    case CellState::kUnknown:
      break;
  }
  return static_cast<char>(205);
}

/// The grid as a binary PGM, the header first and then row by row from the top: never whole in memory.
class PgmWriter {
 public:
  explicit PgmWriter(const OccupancyGrid& grid)
      : grid_{grid},
        next_row_{grid.height()},
        piece_{"P5\n" + std::to_string(grid.width()) + " " + std::to_string(grid.height()) + "\n255\n"} {}

  /// Nothing at the end.
  [[nodiscard]] std::string_view next_piece() {
    const int row = next_row_--;
    if (row < 0) return {};
    if (row < grid_.height()) lay_out(row);
    return piece_;
  }

 private:
  void lay_out(int row) {
    piece_.assign(static_cast<std::size_t>(grid_.width()), shade_of(grid_.fill()));
    grid_.tiles().visit_written({{0, row}, {grid_.width(), row + 1}},
                                [&](Cell first, std::span<const CellState> cells) {
                                  std::transform(cells.begin(), cells.end(), piece_.begin() + first.column, shade_of);
                                });
  }

  const OccupancyGrid& grid_;
  int next_row_;  // the height stands for the header
  std::string piece_;
};

}  // namespace

std::filesystem::path picture_named_in(const std::filesystem::path& yaml_file) {
  constexpr std::uintmax_t kLargest = 1'000'000;
  std::error_code error;
  if (std::filesystem::is_regular_file(yaml_file, error) && std::filesystem::file_size(yaml_file, error) <= kLargest) {
    try {
      return yaml_file.parent_path() / read_grid_description(yaml_file).image;
    } catch (const std::runtime_error&) {  // whoever reads the map says why
    }
  }
  return std::filesystem::path(yaml_file).replace_extension(".pgm");
}

std::string yaml_of(const OccupancyGrid& grid, const std::string& image) {
  const Point2& origin = grid.geometry().origin;
  return "image: " + image + "\nresolution: " + shortest_text(grid.resolution_m()) + "\norigin: [" +
         shortest_text(origin.x()) + ", " + shortest_text(origin.y()) +
         ", 0.0]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n";
}

std::string pgm_of(const OccupancyGrid& grid) {
  std::string bytes;
  PgmWriter pgm{grid};
  for (std::string_view piece = pgm.next_piece(); !piece.empty(); piece = pgm.next_piece()) bytes += piece;
  return bytes;
}

bool is_carmen_map(const std::filesystem::path& file, std::string_view first_bytes) {
  constexpr std::size_t kLongestHeader = 4096;  // lines of comment come before the magic word
  if (first_bytes.starts_with("\x1F\x8B")) {
    return file.extension() == ".map" || file.stem().extension() == ".map";  // of X.map and X.map.gz
  }
  return first_bytes.substr(0, kLongestHeader).find("CARMENMAPFILE") != std::string_view::npos;
}

OccupancyGrid read_grid(const std::filesystem::path& yaml_file) {
  MapFiles files{yaml_file};
  const CellStates states = files.states();
  OccupancyGrid grid{files.geometry()};
  files.visit_shown([&](Cell first, std::string_view shades) {
    for (int i = 0; i < static_cast<int>(shades.size()); ++i) {
      grid.set({first.column + i, first.row}, states[static_cast<unsigned char>(shades[static_cast<std::size_t>(i)])]);
    }
  });
  return grid;
}

GridFileFacts grid_file_facts(const std::filesystem::path& yaml_file) {
  const MapFiles files{yaml_file};
  return {files.geometry(), files.keys().occupied_threshold, files.keys().free_threshold};
}

std::uint64_t shown_cells(const std::filesystem::path& yaml_file) {
  MapFiles files{yaml_file};
  std::uint64_t tiles = 0;
  std::vector<int> last_row((static_cast<std::size_t>(files.geometry().width) + kTogether - 1) / kTogether, -1);
  files.visit_shown([&](Cell first, std::string_view) {
    int& row = last_row[static_cast<std::size_t>(first.column / kTogether)];
    const int of_tiles = first.row / kTogether;
    if (std::exchange(row, of_tiles) != of_tiles) ++tiles;
  });
  return tiles * kTogether * kTogether;
}

namespace {

/// There is one, and it says something else.
bool is_other_text(const std::filesystem::path& file, const std::string& text) {
  try {
    return text_of_file(file) != text;
  } catch (const std::runtime_error&) {
    return false;
  }
}

/// The old description would be wrong for the new picture: it goes before that comes, once both are on disk.
void replace_both(PgmWriter& pgm, const std::filesystem::path& image, const std::string& text,
                  const std::filesystem::path& yaml_file) {
  const std::filesystem::path next_image = image.string() + ".next";
  const std::filesystem::path next_yaml = yaml_file.string() + ".next";
  std::error_code none;
  try {
    replace_file(next_image, [&] { return pgm.next_piece(); });
    replace_file(next_yaml, text);
    std::filesystem::remove(yaml_file, none);
    move_into_place(next_image, image);
    move_into_place(next_yaml, yaml_file);
  } catch (const std::runtime_error&) {
    std::filesystem::remove(next_image, none);
    std::filesystem::remove(next_yaml, none);
    throw;
  }
}

}  // namespace

void write_grid(const OccupancyGrid& grid, const std::filesystem::path& yaml_file) {
  std::filesystem::path image = yaml_file;
  image.replace_extension(".pgm");
  if (image == yaml_file) refuse(yaml_file, "must name a description, NAME.yaml: its picture is NAME.pgm");
  const std::string text = yaml_of(grid, image.filename().string());
  PgmWriter pgm{grid};
  if (is_other_text(yaml_file, text)) return replace_both(pgm, image, text, yaml_file);
  replace_file(image, [&] { return pgm.next_piece(); });
  replace_file(yaml_file, text);
}

}  // namespace deltamap
