// SPDX-License-Identifier: Apache-2.0
// What stands below a drawn map: a scale bar of a round length, and a key for each colour and sign.
#pragma once

#include <string>
#include <vector>

#include "tool/picture/canvas.hpp"
#include "tool/picture/ink.hpp"

namespace deltamap::tool::picture {

enum class Sign { kCell, kLine, kDot, kArrow, kCircle };

struct Key {
  Sign sign;
  Ink ink;
  std::string text;
};

/// A length of 1, 2 or 5 times a power of ten that is at most `most_px` long, in m.
[[nodiscard]] double scale_length_m(double pixels_per_m, double most_px);

struct Legend {
  Canvas canvas;
  int rows;  ///< of pixels that are used
};

/// Rows of keys that fit `width`, with the scale bar before the first.
[[nodiscard]] Legend drawn_legend(const std::vector<Key>& keys, double pixels_per_m, int width);

}  // namespace deltamap::tool::picture
