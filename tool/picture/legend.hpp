// SPDX-License-Identifier: Apache-2.0
// What stands below a drawn map: a scale bar of a round length, and a key for each colour and sign.
#pragma once

#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "tool/picture/ink.hpp"

namespace deltamap::tool::picture {

enum class Sign { kCell, kLine, kDot, kArrow, kCircle };

struct Key {
  Sign sign;
  Ink ink;
  std::string text;
};

/// OpenCV's order of colours.
[[nodiscard]] inline cv::Scalar colour(const Ink& ink) { return {double(ink[2]), double(ink[1]), double(ink[0])}; }

void draw_text(cv::Mat& canvas, const std::string& text, cv::Point left_and_base);
void draw_robot(cv::Mat& canvas, cv::Point2d middle, double heading_rad, double radius);
void draw_ring(cv::Mat& canvas, cv::Point middle, int radius);

/// A length of 1, 2 or 5 times a power of ten that is at most `most_px` long, in m.
[[nodiscard]] double scale_length_m(double pixels_per_m, double most_px);

/// Rows of keys that fit `width`, with the scale bar before the first.
[[nodiscard]] cv::Mat drawn_legend(const std::vector<Key>& keys, double pixels_per_m, int width);

}  // namespace deltamap::tool::picture
