// SPDX-License-Identifier: Apache-2.0
// An animated PNG (APNG, W3C PNG 3rd edition): every browser plays it, every other program shows its first frame.
#pragma once

#include <string>
#include <vector>

#include "tool/picture/raster.hpp"

namespace deltamap::tool::picture {

struct Frame {
  Raster raster;  ///< all frames of one size
  int shown_ms = 100;
};

/// The bytes of a file that plays on and on; a frame holds just the box that differs from the one before. At least one
/// frame.
[[nodiscard]] std::string animated_png(const std::vector<Frame>& frames);

}  // namespace deltamap::tool::picture
