// SPDX-License-Identifier: Apache-2.0
#include "experiments/report/svg_chart.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace deltamap::experiments {
namespace {

constexpr double kWidth = 760.0;
constexpr double kHeight = 320.0;
constexpr double kLeft = 70.0;
constexpr double kRight = 190.0;  // room for the names of the lines
constexpr double kTop = 34.0;
constexpr double kBottom = 48.0;
constexpr std::array<const char*, 8> kColours{"#1f5fa8", "#c4531c", "#2d8a4e", "#8b3fa0",
                                              "#a88a12", "#3a9fa8", "#b02a4c", "#666666"};

struct Extent {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();
  void take(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
  /// Never empty, never of no length.
  [[nodiscard]] Extent usable() const {
    if (!(low <= high)) return {0.0, 1.0};
    return low < high ? *this : Extent{low - 0.5, high + 0.5};
  }
};

/// 1, 2 or 5 times a power of ten, about five of which fill the extent.
double tick_step(const Extent& extent) {
  const double rough = (extent.high - extent.low) / 5.0;
  const double power = std::pow(10.0, std::floor(std::log10(rough)));
  const double share = rough / power;
  return power * (share < 1.5 ? 1.0 : share < 3.5 ? 2.0 : share < 7.5 ? 5.0 : 10.0);
}

std::vector<double> ticks(const Extent& extent) {
  const double step = tick_step(extent);
  const double first = std::ceil(extent.low / step);
  const int more = static_cast<int>(std::floor(extent.high / step + 1e-9) - first);
  std::vector<double> at;
  for (int i = 0; i <= more; ++i) at.push_back((first + i) * step);
  return at;
}

class Frame {
 public:
  Frame(const Extent& x, const Extent& y) : x_{x}, y_{y} {}
  [[nodiscard]] double across(double x) const {
    return kLeft + (x - x_.low) / (x_.high - x_.low) * (kWidth - kLeft - kRight);
  }
  [[nodiscard]] double down(double y) const {
    return kHeight - kBottom - (y - y_.low) / (y_.high - y_.low) * (kHeight - kTop - kBottom);
  }
  [[nodiscard]] std::string axes() const {
    std::string svg;
    for (const double x : ticks(x_)) {
      svg += line(x, y_.low, x, y_.high) + label(across(x), kHeight - kBottom + 16.0, "middle", text_of(cleaned(x)));
    }
    for (const double y : ticks(y_)) {
      svg += line(x_.low, y, x_.high, y) + label(kLeft - 6.0, down(y) + 4.0, "end", text_of(cleaned(y)));
    }
    return svg;
  }
  [[nodiscard]] std::string diagonal() const {
    const double low = std::max(x_.low, y_.low);
    const double high = std::min(x_.high, y_.high);
    return low < high ? line(low, low, high, high) : "";
  }
  [[nodiscard]] static std::string label(double across, double down, const char* anchor, const std::string& text) {
    return "<text x=\"" + text_of(across) + "\" y=\"" + text_of(down) + "\" text-anchor=\"" + anchor + "\">" +
           escaped(text) + "</text>\n";
  }

 private:
  [[nodiscard]] static double cleaned(double tick) { return std::abs(tick) < 1e-12 ? 0.0 : tick; }
  [[nodiscard]] std::string line(double x1, double y1, double x2, double y2) const {
    return "<line x1=\"" + text_of(across(x1)) + "\" y1=\"" + text_of(down(y1)) + "\" x2=\"" + text_of(across(x2)) +
           "\" y2=\"" + text_of(down(y2)) + "\" stroke=\"#ccc\"/>\n";
  }
  Extent x_;
  Extent y_;
};

std::string polyline_of(const Series& series, const Frame& frame, const char* colour) {
  std::string points;
  for (const auto& [x, y] : series.points) {
    if (!std::isfinite(x) || !std::isfinite(y)) continue;
    points += text_of(frame.across(x)) + "," + text_of(frame.down(y)) + " ";
  }
  return "<polyline fill=\"none\" stroke-width=\"1.5\" stroke=\"" + std::string{colour} + "\" points=\"" + points +
         "\"/>\n";
}

}  // namespace

std::string escaped(const std::string& text) {
  std::string safe;
  for (const char c : text) {
    switch (c) {
      case '<':
        safe += "&lt;";
        break;
      case '>':
        safe += "&gt;";
        break;
      case '&':
        safe += "&amp;";
        break;
      case '"':
        safe += "&quot;";
        break;
      default:
        safe += c;
    }
  }
  return safe;
}

std::string svg_of(const Chart& chart) {
  Extent x;
  Extent y;
  y.take(0.0);
  for (const Series& series : chart.series) {
    for (const auto& [px, py] : series.points) {
      if (!std::isfinite(px) || !std::isfinite(py)) continue;
      x.take(px);
      y.take(py);
    }
  }
  const Frame frame{x.usable(), y.usable()};
  std::string svg = "<svg viewBox=\"0 0 " + text_of(kWidth) + " " + text_of(kHeight) + "\" role=\"img\">\n";
  svg += frame.axes();
  if (chart.with_diagonal) svg += frame.diagonal();
  for (std::size_t i = 0; i < chart.series.size(); ++i) {
    const char* colour = kColours[i % kColours.size()];
    svg += polyline_of(chart.series[i], frame, colour);
    const double down = kTop + 16.0 * static_cast<double>(i);
    svg += "<rect x=\"" + text_of(kWidth - kRight + 12.0) + "\" y=\"" + text_of(down - 5.0) +
           "\" width=\"14\" height=\"3\" fill=\"" + colour + "\"/>\n";
    svg += Frame::label(kWidth - kRight + 32.0, down, "start", chart.series[i].name);
  }
  svg += Frame::label(kLeft, 18.0, "start", chart.y);
  svg += Frame::label(0.5 * (kLeft + kWidth - kRight), kHeight - 10.0, "middle", chart.x);
  return svg + "</svg>\n";
}

}  // namespace deltamap::experiments
