// SPDX-License-Identifier: Apache-2.0
#include "tool/picture/legend.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

namespace deltamap::tool::picture {
namespace {

constexpr int kRow_px = 24;
constexpr int kMargin_px = 10;
constexpr int kSign_px = 22;    // room for a sign, with the gap behind it
constexpr int kKeyGap_px = 18;  // between keys

void draw_sign(Canvas& canvas, const Key& key, int left, int middle) {
  const Pixel at{left + 7.0, double(middle)};
  switch (key.sign) {
    case Sign::kCell:
      canvas.fill(left, middle - 6, 13, 13, kText);
      canvas.fill(left + 1, middle - 5, 11, 11, key.ink);
      break;
    case Sign::kLine:
      canvas.draw_line({{at.x - 7.0, at.y + 4.0}, {at.x + 7.0, at.y - 4.0}}, key.ink);
      break;
    case Sign::kDot:
      for (const double x : {-5.0, 0.0, 5.0}) canvas.draw_disc({at.x + x, at.y + x / 3.0}, 2, key.ink);
      break;
    case Sign::kArrow:
      canvas.draw_robot(at, 0.0, 7.0);
      break;
    case Sign::kCircle:
      canvas.draw_ring(at, 7);
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
int draw_scale(Canvas& canvas, double pixels_per_m) {
  const double length_m = scale_length_m(pixels_per_m, std::min(120.0, canvas.width() / 3.0));
  const int length = static_cast<int>(std::lround(length_m * pixels_per_m));
  const int base = kRow_px / 2 + 5;
  canvas.fill(kMargin_px, base - 1, length, 2, kText);
  for (const int x : {kMargin_px, kMargin_px + length - 2}) canvas.fill(x, base - 6, 2, 7, kText);
  canvas.draw_text(length_text(length_m), kMargin_px + length + 6, base);
  return kMargin_px + length + 6 + Canvas::text_width(length_text(length_m));
}

}  // namespace

double scale_length_m(double pixels_per_m, double most_px) {
  const double most_m = most_px / pixels_per_m;
  const double power = std::pow(10.0, std::floor(std::log10(most_m)));
  for (const double factor : {5.0, 2.0}) {
    if (factor * power <= most_m) return factor * power;
  }
  return power;
}

Legend drawn_legend(const std::vector<Key>& keys, double pixels_per_m, int width) {
  Canvas canvas{width, kRow_px * (2 + static_cast<int>(keys.size())), kPaper};
  int x = draw_scale(canvas, pixels_per_m) + 2 * kKeyGap_px;
  int row = 0;
  for (const Key& key : keys) {
    const int room = kSign_px + Canvas::text_width(key.text);
    if (x + room > width - kMargin_px && x > kMargin_px) {
      x = kMargin_px;
      ++row;
    }
    const int middle = row * kRow_px + kRow_px / 2;
    draw_sign(canvas, key, x, middle);
    canvas.draw_text(key.text, x + kSign_px, middle + 5);
    x += room + kKeyGap_px;
  }
  return {std::move(canvas), (row + 1) * kRow_px + 6};
}

}  // namespace deltamap::tool::picture
