// SPDX-License-Identifier: Apache-2.0
// How well a beam's end fits each cell of the map: the likelihood field of Thrun, Burgard and Fox, "Probabilistic
// Robotics", 2005, 6.4, as one byte a cell that counts steps of -ln p(z). Only the contours of obstacles attract; a
// solid block does not. A part of it can be computed alone, bit for bit as a whole rebuild would. Where the map shows
// nothing it holds nothing.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/grid/grid_patch.hpp"
#include "core/grid/occupancy_grid.hpp"

namespace deltamap::localization::sensor {

/// p(z) = (1 - random_share) exp(-d² / 2σ²) + random_share, with d the distance of the beam's end from the nearest
/// contour; at least unknown_likelihood where the end lies in unknown space.
struct LikelihoodFieldParams {
  double hit_deviation_m = 0.07;    ///< of laser and map together, m; > 0 (σ_hit); at least 0.7 cells are used
  double random_share = 0.15;       ///< share of beams that hit what no map knows; 0.02..0.5 (z_rand)
  double unknown_likelihood = 0.2;  ///< p(z) of a beam that ends in unknown space; random_share..1
};

/// True for an occupied cell with a free neighbour, or an unknown neighbour that is next to free space (8 and 4
/// neighbours), and for one with neither neighbour in its row, or neither in its column, occupied: the face between two
/// things, of which one may be gone; single cells in unknown space too.
[[nodiscard]] bool is_contour(const OccupancyGrid& map, Cell cell);

class LikelihoodField {
 public:
  /// One step of the bytes is this much of -ln p(z); 255 of them reach 3.98, p = 0.0187.
  static constexpr double kStep = 1.0 / 64.0;

  LikelihoodField(const OccupancyGrid& map, const LikelihoodFieldParams& params);

  [[nodiscard]] const GridGeometry& geometry() const { return geometry_; }
  [[nodiscard]] const LikelihoodFieldParams& params() const { return params_; }

  /// Steps of -ln p(z) for a beam that ends in the cell; outside the map as in unknown space.
  [[nodiscard]] std::uint8_t steps_at(Cell cell) const;

  /// Fewer steps: a contour explains the end rather than chance, p(hit | d) > 1/2.
  [[nodiscard]] std::uint8_t even_steps() const { return even_steps_; }

  /// The same bytes for kernels, as far as they may differ from those of unknown space: row by row with a border of one
  /// unknown cell on each side. The window's first cell is at (column 1, row 1). Neither the window nor its origin
  /// depends on how much unknown space lies around what the map shows.
  struct Bordered {
    const std::uint8_t* bytes = nullptr;
    int width = 0;            ///< columns + 2
    int height = 0;           ///< rows + 2
    Point2 origin{0.0, 0.0};  ///< lower left corner of the window, m, map frame
  };
  [[nodiscard]] Bordered bordered() const {
    return {bytes_.data(), window_.width() + 2, window_.height() + 2, window_origin_};
  }
  /// The cells of the map that the window holds; it may reach beyond the map.
  [[nodiscard]] const CellBox& window() const { return window_; }

  /// Distance from the contour that a byte stands for, m; the farthest one for bytes beyond.
  [[nodiscard]] const std::array<float, 256>& distance_of_steps_m() const { return distance_of_steps_m_; }
  /// The deviation in use, m (σ_hit).
  [[nodiscard]] double hit_deviation_m() const { return hit_deviation_m_; }

  /// Overwrites cells with bytes that were computed aside.
  void apply(const FieldPatch& patch);

 private:
  /// Makes the window hold the box too.
  void widen(const CellBox& box);
  [[nodiscard]] std::size_t index_of(Cell cell) const {
    return static_cast<std::size_t>(cell.row - window_.first.row + 1) * static_cast<std::size_t>(window_.width() + 2) +
           static_cast<std::size_t>(cell.column - window_.first.column + 1);
  }

  GridGeometry geometry_;
  LikelihoodFieldParams params_;
  double hit_deviation_m_;
  std::uint8_t even_steps_;
  std::array<float, 256> distance_of_steps_m_;
  CellBox window_;  // whole blocks of the frame
  Point2 window_origin_{0.0, 0.0};
  std::vector<std::uint8_t> bytes_;
};

/// The bytes that a full rebuild on `map` would hold in every cell that the changes can have touched.
[[nodiscard]] FieldPatch field_patch(const OccupancyGrid& map, std::span<const CellChange> changes,
                                     const LikelihoodFieldParams& params);

}  // namespace deltamap::localization::sensor
