// SPDX-License-Identifier: Apache-2.0
#include "experiments/merge/merge_layouts.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/random.hpp"

namespace deltamap::experiments {
namespace {

constexpr double kCell_m = 0.02;  // odd parts of 0.1 m: centres fall on centres
constexpr double kMargin_m = 0.5;

/// Cells that hold width × height metres from (0, 0), and a margin.
OccupancyGrid unknown_place(double width_m, double height_m) {
  const auto cells = [](double length_m) {
    return static_cast<int>(std::lround((length_m + 2 * kMargin_m) / kCell_m));
  };
  return OccupancyGrid{{cells(width_m), cells(height_m), kCell_m, {-kMargin_m, -kMargin_m}}};
}

/// Fills the cells whose centre the shape holds; nothing of it lies farther than `reach_m` from the middle.
template <typename Holds>
void fill_where(OccupancyGrid& grid, const Point2& middle, double reach_m, CellState state, Holds&& holds) {
  const Cell low = grid.geometry().cell_at(middle - Point2{reach_m, reach_m});
  const Cell high = grid.geometry().cell_at(middle + Point2{reach_m, reach_m});
  for (int row = std::max(0, low.row); row <= std::min(grid.height() - 1, high.row); ++row) {
    for (int column = std::max(0, low.column); column <= std::min(grid.width() - 1, high.column); ++column) {
      if (holds(Point2{grid.geometry().centre_of({column, row}) - middle})) grid.set({column, row}, state);
    }
  }
}

/// A rectangle about its middle, turned.
void fill_turned(OccupancyGrid& grid, const Point2& middle, const Point2& size_m, double turn_rad, CellState state) {
  const double c = std::cos(turn_rad);
  const double s = std::sin(turn_rad);
  fill_where(grid, middle, 0.5 * size_m.norm(), state, [&](const Point2& at) {
    return std::abs(c * at.x() + s * at.y()) < 0.5 * size_m.x() && std::abs(c * at.y() - s * at.x()) < 0.5 * size_m.y();
  });
}

void fill_box(OccupancyGrid& grid, const Point2& low, const Point2& high, CellState state) {
  fill_turned(grid, 0.5 * (low + high), high - low, 0.0, state);
}

void fill_round(OccupancyGrid& grid, const Point2& middle, double radius_m) {
  fill_where(grid, middle, radius_m, CellState::kOccupied, [&](const Point2& at) { return at.norm() < radius_m; });
}

/// Free floor inside walls.
void enclose(OccupancyGrid& grid, double width_m, double height_m, double wall_m) {
  fill_box(grid, {-wall_m, -wall_m}, {width_m + wall_m, height_m + wall_m}, CellState::kOccupied);
  fill_box(grid, {0.0, 0.0}, {width_m, height_m}, CellState::kFree);
}

/// Rooms along y from `low_y_m` to `high_y_m`, with doors in the wall at `door_y_m`.
void draw_rooms(OccupancyGrid& grid, Random& random, double length_m, double low_y_m, double high_y_m,
                double door_y_m) {
  constexpr double kWall_m = 0.15;
  constexpr double kDoor_m = 0.95;
  fill_box(grid, {0.0, door_y_m - 0.5 * kWall_m}, {length_m, door_y_m + 0.5 * kWall_m}, CellState::kOccupied);
  for (double x = 0.0; x < length_m;) {
    double next = x + random.uniform(2.8, 6.0);
    if (next > length_m - 2.8) next = length_m;
    if (next < length_m) {
      fill_box(grid, {next - 0.5 * kWall_m, low_y_m}, {next + 0.5 * kWall_m, high_y_m}, CellState::kOccupied);
    }
    const double door_x = random.uniform(x + 0.3, next - 0.3 - kDoor_m);
    fill_box(grid, {door_x, door_y_m - kWall_m}, {door_x + kDoor_m, door_y_m + kWall_m}, CellState::kFree);
    const auto pieces = 1 + random.index_below(4);
    for (std::uint32_t i = 0; i < pieces; ++i) {
      const Point2 size_m = random.uniform() < 0.5 ? Point2{0.8, 1.6} : Point2{random.uniform(0.4, 1.2), 0.5};
      const Point2 middle{random.uniform(x + 0.8, next - 0.8), random.uniform(low_y_m + 1.2, high_y_m - 1.2)};
      const double turn_rad = random.uniform() < 0.8 ? 0.0 : random.uniform(0.0, std::numbers::pi);
      fill_turned(grid, middle, size_m, turn_rad, CellState::kOccupied);
    }
    x = next;
  }
}

void draw_rack(OccupancyGrid& grid, const Point2& low, double length_m) {
  constexpr double kDepth_m = 1.1;
  constexpr double kBay_m = 2.7;
  constexpr double kPost_m = 0.15;
  double x = 0.0;
  while (x <= length_m) {
    for (const double y : {0.0, kDepth_m - kPost_m}) {
      fill_box(grid, low + Point2{x, y}, low + Point2{x + kPost_m, y + kPost_m}, CellState::kOccupied);
    }
    x += kBay_m;
  }
}

}  // namespace

OccupancyGrid drawn_warehouse(std::uint64_t seed) {
  Random random{seed};
  OccupancyGrid hall = unknown_place(35.0, 35.0);
  enclose(hall, 35.0, 35.0, 0.2);
  for (const double x : {5.0, 20.0}) {
    for (const double y : {5.0, 20.0}) {
      for (int i = 0; i < 16; ++i) {
        if (random.uniform() < 0.3) continue;
        const int row = i / 4;
        const Point2 low{x + 2.5 * (i % 4), y + 2.5 * row};
        fill_box(hall, low, low + Point2{2.5, 2.5}, CellState::kOccupied);
      }
    }
  }
  return hall;
}

OccupancyGrid drawn_offices(std::uint64_t seed) {
  Random random{seed};
  const double width_m = 32.0;
  const double height_m = 20.0;
  OccupancyGrid floor = unknown_place(width_m, height_m);
  enclose(floor, width_m, height_m, 0.2);
  const double lower_m = random.uniform(7.5, 9.5);
  const double upper_m = lower_m + random.uniform(1.8, 2.6);
  draw_rooms(floor, random, width_m, 0.0, lower_m, lower_m);
  draw_rooms(floor, random, width_m, upper_m, height_m, upper_m);
  return floor;
}

OccupancyGrid drawn_racks(std::uint64_t seed) {
  Random random{seed};
  OccupancyGrid store = unknown_place(40.0, 26.0);
  enclose(store, 40.0, 26.0, 0.2);
  double y = 2.5;
  while (y < 23.0) {
    const double cross_aisle_m = random.uniform(14.0, 26.0);
    const double length_m = cross_aisle_m - random.uniform(6.5, 9.0);
    draw_rack(store, {random.uniform(2.5, 6.0), y}, length_m);
    draw_rack(store, {cross_aisle_m + 1.5, y}, random.uniform(6.0, 35.5 - cross_aisle_m));
    y += random.uniform(3.4, 4.6);
  }
  for (int i = 0; i < 14; ++i) {  // pallets
    const Point2 middle{random.uniform(1.5, 38.5), random.uniform(1.0, 25.0)};
    fill_turned(store, middle, {1.2, 0.8}, random.uniform() < 0.6 ? 0.0 : random.uniform(0.0, std::numbers::pi),
                CellState::kOccupied);
  }
  return store;
}

OccupancyGrid drawn_workshop(std::uint64_t seed) {
  Random random{seed};
  OccupancyGrid shop = unknown_place(36.0, 30.0);
  const double wall_m = 0.25;
  const Point2 middle{18.0, 15.0};
  std::vector<std::pair<double, double>> sides;  // bearing of the wall's normal, distance from the middle
  for (int i = 0; i < 7; ++i) {
    const double bearing_rad = 2.0 * std::numbers::pi * (i + random.uniform(-0.25, 0.25)) / 7.0;
    sides.emplace_back(bearing_rad, random.uniform(11.0, 13.5));
  }
  const auto beyond_m = [&](const Point2& at) {
    double most = -1e9;
    for (const auto& [bearing, distance_m] : sides)
      most = std::max(most, at.x() * std::cos(bearing) + at.y() * std::sin(bearing) - distance_m);
    return most;
  };
  fill_where(shop, middle, 19.0, CellState::kOccupied, [&](const Point2& at) { return beyond_m(at) < wall_m; });
  fill_where(shop, middle, 19.0, CellState::kFree, [&](const Point2& at) { return beyond_m(at) < 0.0; });
  for (int i = 0; i < 18; ++i) {
    const Point2 at{random.uniform(-11.0, 11.0), random.uniform(-10.0, 10.0)};
    if (beyond_m(at) > -1.5) continue;
    const Point2 size_m{random.uniform(0.6, 3.5), random.uniform(0.6, 2.0)};
    fill_turned(shop, middle + at, size_m, random.uniform(0.0, std::numbers::pi), CellState::kOccupied);
  }
  for (int i = 0; i < 6; ++i) {
    const double radius_m = random.uniform(0.2, 0.6);
    const Point2 at{random.uniform(-9.0, 9.0), random.uniform(-8.0, 8.0)};
    fill_round(shop, middle + at, radius_m);
  }
  return shop;
}

std::vector<MergeLayout> merge_layouts() {
  return {
      {"warehouse", drawn_warehouse}, {"offices", drawn_offices}, {"racks", drawn_racks}, {"workshop", drawn_workshop}};
}

}  // namespace deltamap::experiments
