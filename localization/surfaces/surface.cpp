// SPDX-License-Identifier: Apache-2.0
#include "localization/surfaces/surface.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "localization/sensor/likelihood_field.hpp"

namespace deltamap::localization::surfaces {
namespace {

constexpr int kWindow = 2;             // cells to each side that give a cell its direction
constexpr double kStraightest = 0.12;  // variance across over variance along, within that window
constexpr double kTurnWithin = 0.90;   // cosine between a cell's normal and its surface's
constexpr double kAsideCells = 1.2;  // of a cell from the line of its surface so far: a gentle slope begins with a step
constexpr double kShortestM = 0.5;
constexpr std::size_t kFewestCells = 4;
constexpr double kRoughestCells = 0.35;  // deviation of its cells from the line: a rougher one shifts as one walks by

/// Moments of a set of points.
struct Moments {
  double n = 0.0, x = 0.0, y = 0.0, xx = 0.0, xy = 0.0, yy = 0.0;

  void add(double px, double py) {
    n += 1.0;
    x += px;
    y += py;
    xx += px * px;
    xy += px * py;
    yy += py * py;
  }
  struct Line {
    Point2 centre;
    Point2 along;
    double variance_along;
    double variance_across;
  };
  [[nodiscard]] Line line() const {
    const double mx = x / n;
    const double my = y / n;
    const double a = xx / n - mx * mx;
    const double b = xy / n - mx * my;
    const double c = yy / n - my * my;
    const double angle = 0.5 * std::atan2(2.0 * b, a - c);
    const double half = 0.5 * std::hypot(a - c, 2.0 * b);
    const double middle = 0.5 * (a + c);
    return {{mx, my}, {std::cos(angle), std::sin(angle)}, middle + half, std::max(0.0, middle - half)};
  }
};

struct ContourCell {
  Cell at;
  Point2 normal{0.0, 0.0};
  double straightness = 1.0;  ///< variance across over along; small is straight
  bool two_sided = false;
  bool taken = false;
};

/// The contour cells of a box, found by their place.
class Contours {
 public:
  Contours(const OccupancyGrid& map, const CellBox& box)
      : map_{map}, box_{box}, width_{box.width() + 2 * kWindow}, height_{box.height() + 2 * kWindow} {
    is_contour_.assign(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_), 0);
    for (int row = 0; row < height_; ++row) {
      for (int column = 0; column < width_; ++column) {
        const Cell cell{box.first.column - kWindow + column, box.first.row - kWindow + row};
        is_contour_[slot(cell)] = sensor::is_contour(map, cell) ? 1 : 0;
      }
    }
    number_.assign(is_contour_.size(), -1);
    for (int row = box.first.row; row < box.last.row; ++row) {
      for (int column = box.first.column; column < box.last.column; ++column) {
        const Cell cell{column, row};
        if (is_contour_[slot(cell)] == 0) continue;
        number_[slot(cell)] = static_cast<int>(cells_.size());
        cells_.push_back(described(cell));
      }
    }
  }

  [[nodiscard]] std::vector<ContourCell>& cells() { return cells_; }
  [[nodiscard]] int number_at(Cell cell) const { return box_.contains(cell) ? number_[slot(cell)] : -1; }

 private:
  [[nodiscard]] std::size_t slot(Cell cell) const {
    return static_cast<std::size_t>(cell.row - box_.first.row + kWindow) * static_cast<std::size_t>(width_) +
           static_cast<std::size_t>(cell.column - box_.first.column + kWindow);
  }

  [[nodiscard]] ContourCell described(Cell cell) const {
    Moments around;
    Point2 to_free{0.0, 0.0};
    double free_cells = 0.0;
    for (int row = -kWindow; row <= kWindow; ++row) {
      for (int column = -kWindow; column <= kWindow; ++column) {
        const Cell near{cell.column + column, cell.row + row};
        if (is_contour_[slot(near)] != 0) around.add(column, row);
        if (map_.at(near) != CellState::kFree) continue;
        to_free += Point2{column, row};
        free_cells += 1.0;
      }
    }
    ContourCell described{.at = cell};
    if (around.n < 3.0 || free_cells == 0.0) return described;  // hidden between things
    const Moments::Line line = around.line();
    described.straightness = line.variance_across / std::max(1e-9, line.variance_along);
    const Point2 across{-line.along.y(), line.along.x()};
    const double towards = across.dot(to_free);
    described.normal = towards < 0.0 ? Point2{-across} : across;
    described.two_sided = std::abs(towards) < 0.4 * free_cells;
    return described;
  }

  const OccupancyGrid& map_;
  CellBox box_;
  int width_;
  int height_;
  std::vector<std::uint8_t> is_contour_;
  std::vector<int> number_;
  std::vector<ContourCell> cells_;
};

/// Grows one surface from a straight cell over its neighbours.
class Growth {
 public:
  Growth(Contours& contours, int seed) : contours_{contours}, normal_{contours.cells()[index(seed)].normal} {
    take(seed);
    for (std::size_t next = 0; next < members_.size(); ++next) take_neighbours(members_[next]);
  }

  [[nodiscard]] bool is_surface(double resolution_m) const {
    if (members_.size() < kFewestCells) return false;
    if (points_.line().variance_across > kRoughestCells * kRoughestCells) return false;
    return length_cells() * resolution_m >= kShortestM;
  }

  [[nodiscard]] Surface surface(const GridGeometry& geometry) const {
    const Moments::Line line = points_.line();
    Point2 normal{-line.along.y(), line.along.x()};
    if (normal.dot(normal_) < 0.0) normal = -normal;
    const auto [low, high] = ends(line);
    const Point2 middle = line.centre + 0.5 * (low + high) * line.along;
    int two_sided = 0;
    for (const int member : members_) two_sided += contours_.cells()[index(member)].two_sided ? 1 : 0;
    const double scatter_cells = std::sqrt(line.variance_across + kOfAnyPlace * kOfAnyPlace / 4.0);
    const double n = static_cast<double>(members_.size());
    return {.centre = geometry.origin + geometry.resolution_m * (middle + Point2{0.5, 0.5}),
            .normal = normal,
            .half_length_m = 0.5 * (high - low + 1.0) * geometry.resolution_m,
            .offset_deviation_m = kOfAnyPlace * geometry.resolution_m,
            .turn_deviation_rad = std::hypot(0.003, scatter_cells / std::sqrt(n * line.variance_along)),
            .two_sided = 2 * two_sided > static_cast<int>(members_.size())};
  }

 private:
  static std::size_t index(int number) { return static_cast<std::size_t>(number); }

  void take(int number) {
    ContourCell& cell = contours_.cells()[index(number)];
    cell.taken = true;
    members_.push_back(number);
    points_.add(cell.at.column, cell.at.row);
  }

  void take_neighbours(int number) {
    const Cell at = contours_.cells()[index(number)].at;
    for (int row = -1; row <= 1; ++row) {
      for (int column = -1; column <= 1; ++column) {
        const int near = contours_.number_at({at.column + column, at.row + row});
        if (near >= 0 && belongs(contours_.cells()[index(near)])) take(near);
      }
    }
  }

  [[nodiscard]] bool belongs(const ContourCell& cell) const {
    if (cell.taken || cell.normal.isZero()) return false;
    if (members_.size() < 3) return cell.normal.dot(normal_) >= kTurnWithin;
    const Moments::Line line = points_.line();
    const Point2 across{-line.along.y(), line.along.x()};
    const Point2 from = Point2{cell.at.column, cell.at.row} - line.centre;
    return std::abs(across.dot(from)) <= kAsideCells && std::abs(across.dot(cell.normal)) >= 0.7;
  }

  [[nodiscard]] std::pair<double, double> ends(const Moments::Line& line) const {
    double low = 0.0;
    double high = 0.0;
    for (const int member : members_) {
      const Cell at = contours_.cells()[index(member)].at;
      const double along = line.along.dot(Point2{at.column, at.row} - line.centre);
      low = std::min(low, along);
      high = std::max(high, along);
    }
    return {low, high};
  }
  [[nodiscard]] double length_cells() const {
    const auto [low, high] = ends(points_.line());
    return high - low + 1.0;
  }

  Contours& contours_;
  Point2 normal_;
  std::vector<int> members_;
  Moments points_;
};

constexpr double kParallelCosine = 0.99;

/// Does one begin where the other ends, or sooner, by their places along the tangent?
bool overlap_along(const Surface& a, const Surface& b) {
  constexpr double kGapM = 0.5;
  return std::abs(a.tangent().dot(b.centre - a.centre)) <= a.half_length_m + b.half_length_m + kGapM;
}

}  // namespace

std::vector<Surface> surfaces_in(const OccupancyGrid& map, const CellBox& box) {
  Contours contours{map, box};
  std::vector<int> seeds;
  for (std::size_t i = 0; i < contours.cells().size(); ++i) {
    const ContourCell& cell = contours.cells()[i];
    if (!cell.normal.isZero() && cell.straightness <= kStraightest) seeds.push_back(static_cast<int>(i));
  }
  std::stable_sort(seeds.begin(), seeds.end(), [&](int a, int b) {
    const auto& cells = contours.cells();
    return cells[static_cast<std::size_t>(a)].straightness < cells[static_cast<std::size_t>(b)].straightness;
  });
  std::vector<Surface> surfaces;
  for (const int seed : seeds) {
    if (contours.cells()[static_cast<std::size_t>(seed)].taken) continue;
    const Growth growth{contours, seed};
    if (growth.is_surface(map.resolution_m())) surfaces.push_back(growth.surface(map.geometry()));
  }
  return surfaces;
}

bool are_one_face(const Surface& a, const Surface& b) {
  constexpr double kOneLineM = 0.1;  // between their lines
  return a.normal.dot(b.normal) >= kParallelCosine && std::abs(a.normal.dot(b.centre - a.centre)) <= kOneLineM &&
         overlap_along(a, b);
}

bool move_as_one(const Surface& a, const Surface& b) {
  constexpr double kThickestM = 6.0;  // of what is moved as one
  if (are_one_face(a, b)) return true;
  const double behind_m = -a.normal.dot(b.centre - a.centre);
  return a.normal.dot(b.normal) <= -kParallelCosine && behind_m > 0.0 && behind_m <= kThickestM && overlap_along(a, b);
}

}  // namespace deltamap::localization::surfaces
