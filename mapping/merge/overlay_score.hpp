// SPDX-License-Identifier: Apache-2.0
// How well a local map lies on the map at a given rotation and shift: the counts of Eq. 11 and the surface found again,
// without building the moved grid. What the merges score their candidates by.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/grid/grid_contour.hpp"
#include "core/grid/occupancy_grid.hpp"
#include "mapping/registration/acceptance.hpp"

namespace deltamap::mapping::merge {

/// A place of the local map on the map, in cells: first turned about the local map's middle, then shifted.
struct CellMotion {
  double turn_rad = 0.0;
  double column = 0.0;  ///< where the middle comes to lie, in columns of the map (centre of cell 0 at 0.5)
  double row = 0.0;
  friend bool operator==(const CellMotion&, const CellMotion&) = default;
};

struct PointInCells {
  float x = 0.0F;
  float y = 0.0F;
};

/// Cells or points of a contour; fewer make no line.
inline constexpr std::size_t kLeastContour = 20;

/// Mean of the cells, in cells from the grid's corner; the grid's own middle where there are none.
[[nodiscard]] Point2 middle_of(std::span<const Cell> contour, const OccupancyGrid& grid);

/// The known cells of a local map about its middle (the mean of its contour), in cells.
class LocalCells {
 public:
  explicit LocalCells(const OccupancyGrid& local);
  /// With its contour, where it is known already.
  LocalCells(const OccupancyGrid& local, std::span<const Cell> contour);
  /// Every n-th cell of each kind, so that at most about `most_cells` are left.
  [[nodiscard]] LocalCells thinned(std::size_t most_cells) const;

  [[nodiscard]] const std::vector<PointInCells>& contour() const { return contour_; }
  [[nodiscard]] const std::vector<PointInCells>& occupied() const { return occupied_; }
  [[nodiscard]] const std::vector<PointInCells>& free() const { return free_; }
  [[nodiscard]] double occupied_weight() const { return occupied_weight_; }  ///< cells that each point stands for
  [[nodiscard]] double free_weight() const { return free_weight_; }
  [[nodiscard]] const Point2& middle_in_local() const { return middle_in_local_; }

 private:
  Point2 middle_in_local_{0.0, 0.0};
  std::vector<PointInCells> contour_;
  std::vector<PointInCells> occupied_;
  std::vector<PointInCells> free_;
  double occupied_weight_ = 1.0;
  double free_weight_ = 1.0;
};

struct OverlayScore {
  double agreeing = 0.0;           ///< Eq. 11
  double disagreeing = 0.0;        ///< Eq. 11
  double surface_found = 0.0;      ///< share of the whole local contour that lies on or beside the map's contour
  double surface_agreement = 0.0;  ///< the same of the part that lies on known cells
  double overlap = 0.0;            ///< share of the local map's known cells that lie on known cells

  /// Eq. 11
  [[nodiscard]] double acceptance() const { return agreeing > 0.0 ? agreeing / (agreeing + disagreeing) : 0.0; }
};

/// The map, prepared for many looks.
class OverlayMap {
 public:
  explicit OverlayMap(const OccupancyGrid& map);
  /// With its contour, where it is known already.
  OverlayMap(const OccupancyGrid& map, std::span<const Cell> contour);
  [[nodiscard]] OverlayScore score(const LocalCells& local, const CellMotion& motion) const;

 private:
  struct Counts {
    std::uint64_t on_free = 0;
    std::uint64_t on_occupied = 0;
    std::uint64_t near_contour = 0;
    std::uint64_t near_or_known = 0;
  };
  [[nodiscard]] Counts counts(std::span<const PointInCells> points, const CellMotion& motion) const;

  // With a border of one cell that knows nothing; its first cell answers for all that lies outside.
  int width_ = 0;
  int height_ = 0;
  std::vector<std::uint8_t> labels_;
};

/// A contour about the middle of the whole grid, as Hough spectra are taken.
[[nodiscard]] std::vector<PointInCells> about_centre(std::span<const Cell> contour, const OccupancyGrid& grid);

/// A motion turns the local map about its middle.
[[nodiscard]] Pose2 map_from_local(const CellMotion& motion, const GridGeometry& map, const Point2& middle_in_local);
[[nodiscard]] CellMotion cell_motion(const Pose2& map_from_local, const GridGeometry& map,
                                     const Point2& middle_in_local);
[[nodiscard]] inline Pose2 map_from_local(const CellMotion& motion, const GridGeometry& map, const LocalCells& local) {
  return map_from_local(motion, map, local.middle_in_local());
}
[[nodiscard]] inline CellMotion cell_motion(const Pose2& map_from_local, const GridGeometry& map,
                                            const LocalCells& local) {
  return cell_motion(map_from_local, map, local.middle_in_local());
}

}  // namespace deltamap::mapping::merge
