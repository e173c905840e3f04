// SPDX-License-Identifier: Apache-2.0
#include "mapping/things/outline_fit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

namespace deltamap::mapping::things {
namespace {

constexpr double kCoarse_rad = 3.0 * std::numbers::pi / 180.0;
constexpr double kFine_rad = 0.5 * std::numbers::pi / 180.0;
constexpr double kOnSide_cells = 1.5;  // a cell so near to a side lies on it
constexpr double kWholeSideShare = 0.8;
constexpr double kBeside_cells = 2.0;         // of a surface; floor that reaches no farther beyond it tells nothing
constexpr int kHiddenGap_cells = 2;           // between a body and a neighbour that hid its side
constexpr double kSeenShare = 0.5;            // of a side's length
constexpr std::size_t kMostForHeading = 256;  // cells; more are thinned out

struct Extent {
  double low_u = std::numeric_limits<double>::infinity();
  double high_u = -std::numeric_limits<double>::infinity();
  double low_v = std::numeric_limits<double>::infinity();
  double high_v = -std::numeric_limits<double>::infinity();

  void add(const Point2& own) {
    low_u = std::min(low_u, own.x());
    high_u = std::max(high_u, own.x());
    low_v = std::min(low_v, own.y());
    high_v = std::max(high_v, own.y());
  }
  [[nodiscard]] double along_u() const { return high_u - low_u; }
  [[nodiscard]] double along_v() const { return high_v - low_v; }
};

Point2 turned(const Point2& place, double cosine, double sine) {
  return {cosine * place.x() + sine * place.y(), cosine * place.y() - sine * place.x()};
}

std::vector<Point2> turned(const std::vector<Point2>& places, double heading_rad) {
  const double cosine = std::cos(heading_rad);
  const double sine = std::sin(heading_rad);
  std::vector<Point2> own;
  own.reserve(places.size());
  for (const Point2& place : places) own.push_back(turned(place, cosine, sine));
  return own;
}

Extent extent_of(const std::vector<Point2>& own) {
  Extent extent;
  for (const Point2& place : own) extent.add(place);
  return extent;
}

struct Fit {
  std::size_t on_sides = 0;
  double area_m2 = std::numeric_limits<double>::infinity();
};

Fit fit_at(const std::vector<Point2>& faces, double heading_rad, double resolution_m) {
  const std::vector<Point2> own = turned(faces, heading_rad);
  const Extent extent = extent_of(own);
  Fit fit{0, (extent.along_u() + resolution_m) * (extent.along_v() + resolution_m)};
  for (const Point2& place : own) {
    const double off_m = std::min(
        {place.x() - extent.low_u, extent.high_u - place.x(), place.y() - extent.low_v, extent.high_v - place.y()});
    fit.on_sides += off_m <= resolution_m ? 1 : 0;
  }
  return fit;
}

/// More cells on a side are better, then less area: by the cells that one row of cells of more area would hold.
double worth(const Fit& fit, double resolution_m) {
  return static_cast<double>(fit.on_sides) - fit.area_m2 / resolution_m * 0.25;
}

double best_heading(const std::vector<Point2>& faces, double resolution_m) {
  std::vector<Point2> some;
  const std::size_t every = faces.size() / kMostForHeading + 1;
  for (std::size_t i = 0; i < faces.size(); i += every) some.push_back(faces[i]);
  double best_rad = 0.0;
  double best = -std::numeric_limits<double>::infinity();
  const auto look = [&](double heading_rad) {
    const double value = worth(fit_at(some, heading_rad, resolution_m), resolution_m);
    if (value <= best + 1e-9) return;
    best = value;
    best_rad = heading_rad;
  };
  for (int i = 0; i * kCoarse_rad < std::numbers::pi / 2 - 1e-9; ++i) look(i * kCoarse_rad);
  const double middle_rad = best_rad;
  for (int i = -6; i <= 6; ++i) look(middle_rad + i * kFine_rad);
  return best_rad;
}

/// The same rectangle, its heading along the longer side, in [0, π).
Outline lengthwise(Outline outline) {
  if (outline.length_m < outline.width_m) {
    std::swap(outline.length_m, outline.width_m);
    outline.heading_rad += std::numbers::pi / 2;
  }
  outline.heading_rad = std::fmod(outline.heading_rad + 2.0 * std::numbers::pi, std::numbers::pi);
  return outline;
}

Outline outline_around(const Extent& extent, double heading_rad, double resolution_m) {
  const Point2 own{0.5 * (extent.low_u + extent.high_u), 0.5 * (extent.low_v + extent.high_v)};
  Outline outline;
  outline.centre = turned(own, std::cos(heading_rad), -std::sin(heading_rad));
  outline.length_m = std::max(extent.along_u(), resolution_m);
  outline.width_m = std::max(extent.along_v(), resolution_m);
  outline.heading_rad = heading_rad;
  return lengthwise(outline);
}

/// Places along a side (numbered as Outline has it), so far beyond it.
template <typename Visit>
void along_side(const Outline& outline, int side, double beyond_m, double step_m, Visit&& visit) {
  const bool at_end = side % 2 == 0;
  const double out_m = 0.5 * (at_end ? outline.length_m : outline.width_m) + beyond_m;
  const double half_m = 0.5 * (at_end ? outline.width_m : outline.length_m);
  const double sign = side < 2 ? 1.0 : -1.0;
  const Pose2 map{outline.centre.x(), outline.centre.y(), outline.heading_rad};
  const int steps = std::max(1, static_cast<int>(std::lround(2.0 * half_m / step_m)));
  for (int i = 0; i < steps; ++i) {
    const double along_m = -half_m + (i + 0.5) * 2.0 * half_m / steps;
    visit(map * (at_end ? Point2{sign * out_m, along_m} : Point2{along_m, sign * out_m}));
  }
}

template <typename IsSeen>
bool is_mostly(const Outline& outline, int side, double beyond_m, double step_m, IsSeen&& is_seen) {
  int all = 0;
  int seen = 0;
  along_side(outline, side, beyond_m, step_m, [&](const Point2& place) {
    ++all;
    seen += is_seen(place) ? 1 : 0;
  });
  return seen >= kSeenShare * all;
}

/// The middle one of what the columns reach.
double middle_reach(std::vector<double> reach) {
  const auto middle = reach.begin() + static_cast<std::ptrdiff_t>(reach.size() * 3 / 5);
  std::nth_element(reach.begin(), middle, reach.end());
  return *middle;
}

/// With the floor that has become free beyond the surface towards +v and -v, where that is more than a surface drawn a
/// cell beside.
Extent with_floor(Extent faces, const std::vector<Point2>& inside, double resolution_m) {
  const auto columns = static_cast<std::size_t>(std::lround(faces.along_u() / resolution_m)) + 1;
  std::vector<double> ahead(columns, 0.0);
  std::vector<double> behind(columns, 0.0);
  for (const Point2& own : inside) {
    const double column = std::floor((own.x() - faces.low_u) / resolution_m + 0.5);
    if (column < 0 || column >= static_cast<double>(columns)) continue;
    const auto at = static_cast<std::size_t>(column);
    ahead[at] = std::max(ahead[at], own.y() - faces.high_v);
    behind[at] = std::max(behind[at], faces.low_v - own.y());
  }
  const double ahead_m = middle_reach(std::move(ahead));
  const double behind_m = middle_reach(std::move(behind));
  const bool is_face = faces.along_v() < kOneFace_m;  // what lies before it was free
  if (ahead_m > kBeside_cells * resolution_m && (!is_face || ahead_m > behind_m))
    faces.high_v += ahead_m + resolution_m;
  if (behind_m > kBeside_cells * resolution_m && (!is_face || behind_m >= ahead_m))
    faces.low_v -= behind_m + resolution_m;
  return faces;
}

Extent crosswise(const Extent& extent) { return {extent.low_v, extent.high_v, extent.low_u, extent.high_u}; }

/// A surface lies along all of a side, so far beyond it.
bool is_surface_beyond(const Outline& outline, int side, double beyond_m, const OccupancyGrid& map) {
  int all = 0;
  int covered = 0;
  along_side(outline, side, beyond_m, map.resolution_m(), [&](const Point2& place) {
    ++all;
    covered += map.at(map.geometry().cell_at(place)) == CellState::kOccupied ? 1 : 0;
  });
  return covered >= kWholeSideShare * all;
}

/// The side moved out by so much.
void push_out(Outline& outline, int side, double by_m) {
  const double turn_rad = outline.heading_rad + side * std::numbers::pi / 2;
  outline.centre += 0.5 * by_m * Point2{std::cos(turn_rad), std::sin(turn_rad)};
  (side % 2 == 0 ? outline.length_m : outline.width_m) += by_m;
}

}  // namespace

Outline outline_of_come(const BodyCells& cells) {
  const double heading_rad = best_heading(cells.faces, cells.resolution_m);
  Extent extent = extent_of(turned(cells.faces, heading_rad));
  for (const Point2& own : turned(cells.inside, heading_rad)) extent.add(own);
  Outline outline = outline_around(extent, heading_rad, cells.resolution_m);
  const double near_m = kOnSide_cells * cells.resolution_m;
  const auto is_face = [&](const Point2& place) {
    return std::any_of(cells.faces.begin(), cells.faces.end(),
                       [&](const Point2& face) { return (face - place).squaredNorm() <= near_m * near_m; });
  };
  for (std::size_t side = 0; side < 4; ++side)
    outline.seen[side] = is_mostly(outline, static_cast<int>(side), 0.0, 2.0 * cells.resolution_m, is_face);
  if (outline.width_m < kOneFace_m) outline.seen = {false, true, false, false};
  return outline;
}

Outline outline_of_gone(const BodyCells& cells, const OccupancyGrid& map) {
  const double heading_rad = best_heading(cells.faces, cells.resolution_m);
  Extent extent = extent_of(turned(cells.faces, heading_rad));
  std::vector<Point2> inside = turned(cells.inside, heading_rad);
  double own_rad = heading_rad;
  if (extent.along_u() < extent.along_v()) {  // the face along u
    own_rad += std::numbers::pi / 2;
    extent = extent_of(turned(cells.faces, own_rad));
    inside = turned(cells.inside, own_rad);
  }
  extent = with_floor(extent, inside, cells.resolution_m);
  for (Point2& own : inside) std::swap(own.x(), own.y());
  extent = crosswise(with_floor(crosswise(extent), inside, cells.resolution_m));
  Outline outline = outline_around(extent, own_rad, cells.resolution_m);
  const auto is_known = [&](const Point2& place) {
    return map.at(map.geometry().cell_at(place)) != CellState::kUnknown;
  };
  for (std::size_t side = 0; side < 4; ++side)
    outline.seen[side] =
        is_mostly(outline, static_cast<int>(side), cells.resolution_m, 2.0 * cells.resolution_m, is_known);
  return outline;
}

Outline up_to_neighbours(const Outline& freed, const OccupancyGrid& map) {
  if (freed.width_m < kOneFace_m) return freed;  // nothing is known of its depth
  Outline outline = freed;
  for (int side = 0; side < 4; ++side) {
    for (int cells = 1; cells <= kHiddenGap_cells; ++cells) {
      if (!is_surface_beyond(freed, side, cells * map.resolution_m(), map)) continue;
      push_out(outline, side, cells * map.resolution_m());
      break;
    }
  }
  return lengthwise(outline);
}

double share_on_sides(const BodyCells& cells, const Outline& outline) {
  const Pose2 outline_from_map = inverse({outline.centre.x(), outline.centre.y(), outline.heading_rad});
  const auto on_side = std::count_if(cells.faces.begin(), cells.faces.end(), [&](const Point2& face) {
    const Point2 own = outline_from_map * face;
    const double off_m = std::min(std::abs(std::abs(own.x()) - 0.5 * outline.length_m),
                                  std::abs(std::abs(own.y()) - 0.5 * outline.width_m));
    return off_m <= 2.0 * cells.resolution_m;
  });
  return static_cast<double>(on_side) / static_cast<double>(std::max<std::size_t>(1, cells.faces.size()));
}

}  // namespace deltamap::mapping::things
