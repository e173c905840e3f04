// SPDX-License-Identifier: Apache-2.0
// The coarse field once more, as bounds: of a robot in any of four blocks (a quad, two by two) no beam fits better than
// the best of the four blocks that it may end in. A quad whose bound is too high need not be looked at block by block
// (after Hess, Kohler, Rapp and Andor, "Real-time loop closure in 2D lidar SLAM", ICRA 2016).
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "localization/sensor/turned_beams.hpp"

namespace deltamap::localization::sensor {

class QuadBounds {
 public:
  QuadBounds() = default;
  /// Of so many columns and rows of blocks; all unknown, as beyond them: `unknown` steps.
  QuadBounds(int columns, int rows, std::uint8_t unknown);

  [[nodiscard]] int columns() const { return (columns_ + 1) / 2; }
  [[nodiscard]] int rows() const { return (rows_ + 1) / 2; }

  /// `steps_of(column, row)`: of a block, which has changed; unknown outside.
  template <typename StepsOf>
  void look_at(int column, int row, StepsOf&& steps_of) {
    for (int y = row - 1; y <= row; ++y) {
      for (int x = column - 1; x <= column; ++x) {
        std::uint8_t& best = bytes_[place_of(x, y)];
        best = std::min(std::min(steps_of(x, y), steps_of(x + 1, y)),
                        std::min(steps_of(x, y + 1), steps_of(x + 1, y + 1)));
      }
    }
  }

  static constexpr int kAtOnce = 16;  ///< quads side by side that are looked at together
  /// Sums of steps: no pose in a quad's blocks has less. Of that quad and those to its right; places beyond the end of
  /// the row say nothing.
  [[nodiscard]] std::array<std::uint16_t, kAtOnce> bounds(const TurnedBeams& beams, int column, int row) const;

 private:
  static constexpr int kBefore = kAtOnce + 1;  // of the columns, unknown; the last of them may see the first block
  [[nodiscard]] int padded_columns() const { return kBefore + columns() + kAtOnce; }
  [[nodiscard]] int padded_rows() const { return rows_ + 3; }
  /// Of the four blocks from this one on, by the column's parity first: quads side by side are bytes side by side.
  [[nodiscard]] std::size_t place_of(int column, int row) const {
    const int padded_row = (column & 1) * padded_rows() + row + 2;
    const int padded_column = (column >> 1) + kBefore;
    const int place = padded_row * padded_columns() + padded_column;
    return static_cast<std::size_t>(place);
  }

  int columns_ = 0;  // blocks
  int rows_ = 0;
  std::vector<std::uint8_t> bytes_;
};

}  // namespace deltamap::localization::sensor
