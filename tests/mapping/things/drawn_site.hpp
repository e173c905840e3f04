// SPDX-License-Identifier: Apache-2.0
// A room of 12 m × 10 m at 5 cm that is drawn revision by revision, and the things that this tells of.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "mapping/things/things.hpp"

namespace deltamap::mapping::things {

/// A rectangle along the axes, m.
struct Drawn {
  double low_x = 0.0;
  double low_y = 0.0;
  double high_x = 0.0;
  double high_y = 0.0;
};

class DrawnSite {
 public:
  explicit DrawnSite(const ThingsParams& params = {}) : things{params} {
    for (int row = 0; row < kGeometry.height; ++row) {
      for (int column = 0; column < kGeometry.width; ++column) {
        const bool is_wall = row == 0 || column == 0 || row == kGeometry.height - 1 || column == kGeometry.width - 1;
        map.set({column, row}, is_wall ? CellState::kOccupied : CellState::kFree);
      }
    }
    next = map;
  }

  static constexpr double kCell_m = 0.05;
  static Timestamp at(double time_s) { return timestamp_from_ns(1'000'000'000'000) + duration_from_seconds(time_s); }

  DrawnSite& fill(const Drawn& place, CellState state) {
    const Cell first = kGeometry.cell_at({place.low_x, place.low_y});
    const Cell last = kGeometry.cell_at({place.high_x, place.high_y});
    for (int row = first.row; row <= last.row; ++row) {
      for (int column = first.column; column <= last.column; ++column) set({column, row}, state);
    }
    return *this;
  }
  DrawnSite& set(Cell cell, CellState state) {
    next.set(cell, state);
    return *this;
  }

  // Faces of a box: its own cells along one side.
  DrawnSite& south(const Drawn& box) {
    return fill({box.low_x, box.low_y, box.high_x, box.low_y}, CellState::kOccupied);
  }
  DrawnSite& north(const Drawn& box) {
    return fill({box.low_x, box.high_y, box.high_x, box.high_y}, CellState::kOccupied);
  }
  DrawnSite& west(const Drawn& box) {
    return fill({box.low_x, box.low_y, box.low_x, box.high_y}, CellState::kOccupied);
  }
  DrawnSite& east(const Drawn& box) {
    return fill({box.high_x, box.low_y, box.high_x, box.high_y}, CellState::kOccupied);
  }
  DrawnSite& box(const Drawn& box) { return south(box).north(box).west(box).east(box); }
  DrawnSite& clear(const Drawn& box) { return fill(box, CellState::kFree); }

  /// What was drawn becomes the next revision.
  std::vector<ThingEvent> revision(double time_s, bool takes_back = false) {
    const std::vector<CellChange> changes = changes_between(map, next);
    map = next;
    revisions.push_back(changes);
    return things.take({++number, at(time_s), map, changes, takes_back});
  }
  /// The changes of a revision go back.
  std::vector<ThingEvent> undo(std::uint32_t undone, double time_s) {
    for (const CellChange& change : revisions[undone - 1]) next.set(change.cell, change.before);
    return revision(time_s, true);
  }
  /// Drawn before the first revision.
  void begin_with_what_is_drawn() { map = next; }

  static inline const GridGeometry kGeometry{240, 200, kCell_m, {0.0, 0.0}};
  OccupancyGrid map{kGeometry};
  OccupancyGrid next{map};
  Things things;
  std::uint32_t number = 0;
  std::vector<std::vector<CellChange>> revisions;
};

inline constexpr Drawn kBox{4.0, 4.0, 6.4, 5.6};  // 2.4 m × 1.6 m, in the middle of the floor
inline constexpr double kCells_m = 0.11;          // two cells

inline void expect_outline(const Outline& outline, const Drawn& box) {
  EXPECT_NEAR(outline.length_m, std::max(box.high_x - box.low_x, box.high_y - box.low_y), kCells_m);
  EXPECT_NEAR(outline.width_m, std::min(box.high_x - box.low_x, box.high_y - box.low_y), kCells_m);
  EXPECT_NEAR(outline.centre.x(), 0.5 * (box.low_x + box.high_x), kCells_m);
  EXPECT_NEAR(outline.centre.y(), 0.5 * (box.low_y + box.high_y), kCells_m);
}

}  // namespace deltamap::mapping::things
