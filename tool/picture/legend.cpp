// SPDX-License-Identifier: Apache-2.0
#include "tool/picture/legend.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <opencv2/imgproc.hpp>

namespace deltamap::tool::picture {
namespace {

constexpr int kFont = cv::FONT_HERSHEY_SIMPLEX;
constexpr double kFontScale = 0.45;
constexpr int kRow_px = 24;
constexpr int kMargin_px = 10;
constexpr int kSign_px = 22;  // room for a sign, with the gap behind it
constexpr int kGap_px = 18;   // between keys

int text_width(const std::string& text) {
  int base = 0;
  return cv::getTextSize(text, kFont, kFontScale, 1, &base).width;
}

void draw_sign(cv::Mat& canvas, const Key& key, cv::Point left_and_middle) {
  const cv::Point middle = left_and_middle + cv::Point{7, 0};
  switch (key.sign) {
    case Sign::kCell:
      cv::rectangle(canvas, middle - cv::Point{6, 6}, middle + cv::Point{6, 6}, colour(key.ink), cv::FILLED);
      cv::rectangle(canvas, middle - cv::Point{6, 6}, middle + cv::Point{6, 6}, colour(kText), 1);
      break;
    case Sign::kLine:
      cv::line(canvas, middle - cv::Point{7, -4}, middle + cv::Point{7, -4}, colour(key.ink), 2, cv::LINE_AA);
      break;
    case Sign::kDot:
      for (const int x : {-5, 0, 5}) cv::circle(canvas, middle + cv::Point{x, x / 3}, 2, colour(key.ink), cv::FILLED);
      break;
    case Sign::kArrow:
      draw_robot(canvas, middle, 0.0, 7.0);
      break;
    case Sign::kCircle:
      draw_ring(canvas, middle, 7);
      break;
  }
}

std::string length_text(double length_m) {
  char text[32];
  (void)std::snprintf(text, sizeof text, length_m < 1.0 ? "%.0f cm" : "%.0f m",
                      length_m < 1.0 ? 100.0 * length_m : length_m);
  return text;
}

/// Answers how far right it reaches.
int draw_scale(cv::Mat& canvas, double pixels_per_m) {
  const double length_m = scale_length_m(pixels_per_m, std::min(120.0, canvas.cols / 3.0));
  const int right = kMargin_px + static_cast<int>(std::lround(length_m * pixels_per_m));
  const int base = kRow_px / 2 + 5;
  const cv::Scalar ink = colour(kText);
  cv::line(canvas, {kMargin_px, base}, {right, base}, ink, 2);
  for (const int x : {kMargin_px, right}) cv::line(canvas, {x, base - 5}, {x, base}, ink, 2);
  draw_text(canvas, length_text(length_m), {right + 6, base});
  return right + 6 + text_width(length_text(length_m));
}

}  // namespace

void draw_text(cv::Mat& canvas, const std::string& text, cv::Point left_and_base) {
  cv::putText(canvas, text, left_and_base, kFont, kFontScale, colour(kText), 1, cv::LINE_AA);
}

void draw_robot(cv::Mat& canvas, cv::Point2d middle, double heading_rad, double radius) {
  cv::circle(canvas, middle, static_cast<int>(std::lround(radius)), colour(kRobot), cv::FILLED, cv::LINE_AA);
  std::array<cv::Point, 3> tip;
  const std::array<std::pair<double, double>, 3> corners{{{0.8, 0.0}, {0.75, 2.25}, {0.75, -2.25}}};  // radius, bearing
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const auto [share, bearing] = corners[i];
    tip[i] = middle + radius * share * cv::Point2d{std::cos(heading_rad + bearing), -std::sin(heading_rad + bearing)};
  }
  cv::fillConvexPoly(canvas, tip, colour(kPaper), cv::LINE_AA);
}

void draw_ring(cv::Mat& canvas, cv::Point middle, int radius) {
  cv::circle(canvas, middle, radius, colour(kPaper), 4, cv::LINE_AA);
  cv::circle(canvas, middle, radius, colour(kRing), 2, cv::LINE_AA);
}

double scale_length_m(double pixels_per_m, double most_px) {
  const double most_m = most_px / pixels_per_m;
  const double power = std::pow(10.0, std::floor(std::log10(most_m)));
  for (const double factor : {5.0, 2.0}) {
    if (factor * power <= most_m) return factor * power;
  }
  return power;
}

cv::Mat drawn_legend(const std::vector<Key>& keys, double pixels_per_m, int width) {
  const auto room = [](const Key& key) { return kSign_px + text_width(key.text) + kGap_px; };
  cv::Mat canvas(kRow_px * (2 + static_cast<int>(keys.size())), width, CV_8UC3, colour(kPaper));
  int x = draw_scale(canvas, pixels_per_m) + 2 * kGap_px;
  int row = 0;
  for (const Key& key : keys) {
    if (x + room(key) - kGap_px > width - kMargin_px && x > kMargin_px) {
      x = kMargin_px;
      ++row;
    }
    const int middle = row * kRow_px + kRow_px / 2;
    draw_sign(canvas, key, {x, middle});
    draw_text(canvas, key.text, {x + kSign_px, middle + 5});
    x += room(key);
  }
  return canvas.rowRange(0, (row + 1) * kRow_px + 6).clone();
}

}  // namespace deltamap::tool::picture
