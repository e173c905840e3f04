// SPDX-License-Identifier: Apache-2.0
#include "core/files/grid_file.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <span>
#include <stdexcept>
#include <system_error>
#include <utility>
#include <vector>

#include "core/files/grid_description.hpp"
#include "core/files/grid_shades.hpp"
#include "core/files/picture_reader.hpp"
#include "core/files/replace_file.hpp"
#include "core/files/shortest_text.hpp"
#include "core/files/text_of_file.hpp"
#include "core/geometry/angle.hpp"
#include "core/grid/tiled.hpp"

namespace deltamap {
namespace {

constexpr int kTogether = Tiled<CellState>::kSide;  // pixels
constexpr double kNoTurn_rad = 1e-6;
constexpr double kMostYaw_rad = 2.0 * std::numbers::pi + kNoTurn_rad;  // more is written in degrees
constexpr double kQuarterTurn_rad = 2e-5;  // as 4.7124 is from three quarters: 2 mm at 100 m

[[noreturn]] void refuse(const std::filesystem::path& file, const std::string& why) {
  throw std::runtime_error(file.string() + ": " + why);
}

std::string of_line(int line) { return "line " + std::to_string(line) + ": "; }

/// To a nanometre: an origin that is computed reads as one that was written.
Point2 tidied(const Point2& point) {
  const auto rounded = [](double metres) { return std::round(metres * 1e9) / 1e9 + 0.0; };
  return {rounded(point.x()), rounded(point.y())};
}

/// How a picture lies in the grid of its map: turned by quarters about its lower left corner, which is at the origin of
/// the description.
class Placement {
 public:
  Placement(const GridDescription& keys, const std::filesystem::path& file, int width, int height)
      : width_{width}, height_{height} {
    quarters_ = quarters_in(keys.yaw_rad);
    if (quarters_ < 0) refuse_turn(keys, file);
    const bool is_across = quarters_ % 2 == 1;
    geometry_ = {is_across ? height : width, is_across ? width : height, keys.resolution_m, keys.origin};
    if (quarters_ != 0) geometry_.origin = tidied(lowest_corner(keys, quarters_ * std::numbers::pi / 2.0));
  }

  [[nodiscard]] const GridGeometry& geometry() const { return geometry_; }
  /// Where the cell of a pixel lies; `pixel` counts from the picture's lower left corner.
  [[nodiscard]] Cell cell_of(Cell pixel) const {
    switch (quarters_) {
      case 1:
        return {height_ - 1 - pixel.row, pixel.column};
      case 2:
        return {width_ - 1 - pixel.column, height_ - 1 - pixel.row};
      case 3:
        return {pixel.row, width_ - 1 - pixel.column};
      default:
        return pixel;
    }
  }

 private:
  /// Counterclockwise, 0 to 3; -1 for other turns.
  static int quarters_in(double yaw_rad) {
    constexpr double kQuarter_rad = std::numbers::pi / 2.0;
    const double turns = std::round(std::remainder(yaw_rad, 4.0 * kQuarter_rad) / kQuarter_rad);
    const int quarters = (static_cast<int>(turns) + 4) % 4;
    const double off_rad = std::abs(std::remainder(yaw_rad - turns * kQuarter_rad, 4.0 * kQuarter_rad));
    const bool is_unturned = yaw_rad > -kQuarter_rad && yaw_rad < kQuarter_rad && quarters == 0;
    return off_rad < (is_unturned ? kNoTurn_rad : kQuarterTurn_rad) ? quarters : -1;
  }
  /// Lower left corner of the smallest rectangle that holds the turned picture.
  [[nodiscard]] Point2 lowest_corner(const GridDescription& keys, double yaw_rad) const {
    const Pose2 turned{keys.origin.x(), keys.origin.y(), yaw_rad};
    const double across_m = width_ * keys.resolution_m;
    const double up_m = height_ * keys.resolution_m;
    Point2 lowest = keys.origin;
    for (const Point2& corner : {Point2{across_m, 0.0}, Point2{0.0, up_m}, Point2{across_m, up_m}})
      lowest = lowest.cwiseMin(turned * corner);
    return lowest;
  }
  [[noreturn]] void refuse_turn(const GridDescription& keys, const std::filesystem::path& file) const {
    const auto rounded = [](double value) { return shortest_text(std::round(value * 1e4) / 1e4); };
    if (std::abs(keys.yaw_rad) > kMostYaw_rad) {
      refuse(file, of_line(keys.lines.origin) + "the origin's yaw " + shortest_text(keys.yaw_rad) +
                       " looks like degrees, and radians are meant: " +
                       rounded(std::remainder(radians(keys.yaw_rad), 2.0 * std::numbers::pi)));
    }
    const Point2 origin = lowest_corner(keys, keys.yaw_rad);
    refuse(file, of_line(keys.lines.origin) + "a turned origin (yaw " + shortest_text(keys.yaw_rad) +
                     ") is read for quarter turns alone: turn the picture by " + rounded(degrees(keys.yaw_rad)) +
                     " degrees counterclockwise onto a canvas that holds it whole, its corners unknown (205), and set "
                     "'origin: [" +
                     rounded(origin.x()) + ", " + rounded(origin.y()) + ", 0]'");
  }

  int width_;
  int height_;
  int quarters_ = 0;
  GridGeometry geometry_;
};

std::unique_ptr<PictureReader> picture_of(const GridDescription& keys, const std::filesystem::path& file) {
  std::error_code error;
  if (!std::filesystem::exists(keys.picture, error))
    refuse(file, of_line(keys.lines.image) + "picture " + keys.picture.string() + ": " +
                     (error ? error : std::make_error_code(std::errc::no_such_file_or_directory)).message());
  return open_picture(keys.picture);
}

/// Both files of a map, read from the beginning.
class MapFiles {
 public:
  explicit MapFiles(const std::filesystem::path& yaml_file)
      : file_{yaml_file},
        keys_{read_grid_description(yaml_file)},
        picture_{picture_of(keys_, yaml_file)},
        placement_{keys_, yaml_file, picture_->width(), picture_->height()} {}

  [[nodiscard]] const GridDescription& keys() const { return keys_; }
  [[nodiscard]] const Placement& placement() const { return placement_; }
  [[nodiscard]] const GridGeometry& geometry() const { return placement_.geometry(); }
  [[nodiscard]] CellState state_of(Shade shade) const { return states_[shade]; }
  /// What was told of the files so far; of their shades once they have been visited.
  [[nodiscard]] const std::vector<std::string>& notes() const { return notes_; }

  /// Once: `visit(Cell first, std::span<const Shade> shades)` for the pieces of rows in which something is known, from
  /// the top; cells are those of the picture. A piece lies in one column of the picture's tiles.
  template <typename Visit>
  void visit_shown(Visit&& visit) {
    learn_shades();
    std::vector<Shade> row(static_cast<std::size_t>(picture_->width()));
    for (int below = picture_->height() - 1; below >= 0; --below) {
      picture_->read_row(row);
      for (int column = 0; column < picture_->width(); column += kTogether) {
        const std::span<const Shade> left = std::span{row}.subspan(static_cast<std::size_t>(column));
        const std::span<const Shade> piece = left.first(std::min<std::size_t>(left.size(), kTogether));
        const bool is_unknown = state_of(piece.front()) == CellState::kUnknown;
        if (is_unknown && std::equal(piece.begin() + 1, piece.end(), piece.begin())) continue;  // most of a large map
        visit({column, below}, piece);
      }
    }
  }

 private:
  /// Reads the picture once before its cells: what a shade means depends on which others there are.
  void learn_shades() {
    const auto before = open_picture(keys_.picture);
    const ShadeCensus census = census_of(*before);
    states_ = states_of(census, keys_);
    notes_ = keys_.notes;
    const std::vector<std::string> of_picture = before->notes();
    notes_.insert(notes_.end(), of_picture.begin(), of_picture.end());
    for (const std::string& doubt : doubts_of(census, keys_)) notes_.push_back(file_.string() + ": " + doubt);
  }

  std::filesystem::path file_;
  GridDescription keys_;
  std::unique_ptr<PictureReader> picture_;
  Placement placement_;
  std::vector<CellState> states_;
  std::vector<std::string> notes_;
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
      return read_grid_description(yaml_file).picture;
    } catch (const std::runtime_error&) {  // whoever reads the map says why
    }
  }
  return std::filesystem::path(yaml_file).replace_extension(".pgm");
}

std::string yaml_of(const OccupancyGrid& grid, const std::string& image) {
  const Point2& origin = grid.geometry().origin;
  return "image: " + image + "\nresolution: " + yaml_number(grid.resolution_m()) + "\norigin: [" +
         yaml_number(origin.x()) + ", " + yaml_number(origin.y()) +
         ", 0.0]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n";
}

std::string pgm_of(const OccupancyGrid& grid) {
  std::string bytes;
  PgmWriter pgm{grid};
  for (std::string_view piece = pgm.next_piece(); !piece.empty(); piece = pgm.next_piece()) bytes += piece;
  return bytes;
}

GridWithNotes read_grid_with_notes(const std::filesystem::path& yaml_file) {
  MapFiles files{yaml_file};
  OccupancyGrid grid{files.geometry()};
  files.visit_shown([&](Cell first, std::span<const Shade> shades) {
    for (std::size_t i = 0; i < shades.size(); ++i) {
      const Cell pixel{first.column + static_cast<int>(i), first.row};
      grid.set(files.placement().cell_of(pixel), files.state_of(shades[i]));
    }
  });
  return {std::move(grid), files.notes()};
}

OccupancyGrid read_grid(const std::filesystem::path& yaml_file) { return read_grid_with_notes(yaml_file).grid; }

GridGeometry grid_file_geometry(const std::filesystem::path& yaml_file) { return MapFiles{yaml_file}.geometry(); }

std::uint64_t shown_cells(const std::filesystem::path& yaml_file) {
  MapFiles files{yaml_file};
  const auto tiles_along = [](int cells) { return (static_cast<std::size_t>(cells) + kTogether - 1) / kTogether; };
  const std::size_t across = tiles_along(files.geometry().width);
  std::vector<bool> is_shown(across * tiles_along(files.geometry().height));
  files.visit_shown([&](Cell first, std::span<const Shade> shades) {
    for (const int column : {first.column, first.column + static_cast<int>(shades.size()) - 1}) {
      const Cell cell = files.placement().cell_of({column, first.row});
      is_shown[static_cast<std::size_t>(cell.row / kTogether) * across +
               static_cast<std::size_t>(cell.column / kTogether)] = true;
    }
  });
  const auto tiles = static_cast<std::uint64_t>(std::count(is_shown.begin(), is_shown.end(), true));
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
