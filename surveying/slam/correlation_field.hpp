// SPDX-License-Identifier: Apache-2.0
// Where a scan lies among the ends of others, searched in a whole window: each pose is worth the mean likelihood of the
// scan's ends there, and branch and bound finds the best pose of the lattice (Olson, "Real-time correlative scan
// matching", 2009; Hess et al., "Real-time loop closure in 2D LIDAR SLAM", 2016, §V-B).
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/geometry/pose2.hpp"
#include "core/grid/grid_geometry.hpp"

namespace deltamap::surveying::slam {

/// How likely a beam ends in each cell, from where others ended: exp(-d² / 2σ²) with the distance d to the nearest end.
class CorrelationField {
 public:
  /// Cells of `resolution_m`; σ is one and a half of them. A search may begin with 2^(levels - 1) cells at once; > 0.
  CorrelationField(std::span<const Point2> ends, double resolution_m, int levels);

  [[nodiscard]] double resolution_m() const { return resolution_m_; }
  [[nodiscard]] int levels() const { return static_cast<int>(levels_.size()); }
  /// The cell of a place, counted from the field's corner; any place has one.
  [[nodiscard]] Cell cell_at(const Point2& place) const {
    return {rounded_down((place.x() - corner_.x()) / resolution_m_),
            rounded_down((place.y() - corner_.y()) / resolution_m_)};
  }

  /// Of each cell the largest value of the 2^level cells to the right of and above it, itself included; 0 to 255.
  class Level {
   public:
    /// Where it can be other than 0.
    [[nodiscard]] bool reaches(int column, int row) const {
      return static_cast<unsigned>(column + border_) < static_cast<unsigned>(width_) &&
             static_cast<unsigned>(row + border_) < static_cast<unsigned>(height_);
    }
    [[nodiscard]] const std::uint8_t* values() const { return values_.data(); }
    /// Of a cell in values(), where it is reached; those beside it follow, those of the next row stride() on.
    [[nodiscard]] std::ptrdiff_t index_of(int column, int row) const {
      return std::ptrdiff_t{row + border_} * width_ + column + border_;
    }
    [[nodiscard]] int stride() const { return width_; }

   private:
    friend class CorrelationField;
    Level(int width, int height, int border);
    std::uint8_t* row(int y) { return values_.data() + std::ptrdiff_t{y} * width_; }
    void lay_around(Cell end);
    [[nodiscard]] Level coarser(int reach) const;

    int width_ = 0;
    int height_ = 0;
    int border_ = 0;                    // cells before the field's corner from which its values can be reached
    std::vector<std::uint8_t> values_;  // row by row, and some bytes more
  };
  [[nodiscard]] const Level& level(int level) const { return levels_[static_cast<std::size_t>(level)]; }

 private:
  double resolution_m_;
  Point2 corner_{0.0, 0.0};
  std::vector<Level> levels_;
};

/// The poses that are searched: the centre, so far to each side of it.
struct SearchWindow {
  Pose2 centre;
  double position_m = 0.0;   ///< along x and along y
  double heading_rad = 0.0;  ///< at most π
};

struct CorrelativeMatch {
  Pose2 field_from_scan;
  double score = 0.0;      ///< mean likelihood of the scan's ends, [0, 1]
  bool is_at_rim = false;  ///< of the window: beyond it others may be better
  double elsewhere = 0.0;  ///< score of the best pose that is not the same place, where it comes near; else 0
};

/// The best pose of the window, where its score is above `least_score`. Poses elsewhere are told of where they reach
/// `near_share` of it; >= 1: not looked for.
[[nodiscard]] std::optional<CorrelativeMatch> best_match(const CorrelationField& field, std::span<const Point2> ends,
                                                         const SearchWindow& window, double least_score,
                                                         double near_share);

}  // namespace deltamap::surveying::slam
