// SPDX-License-Identifier: Apache-2.0
#include "reports/svg_chart.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "reports/number_text.hpp"

namespace deltamap::reports {
namespace {

constexpr double kWidth = 480.0;  // as wide as a column: the text stays readable on a phone
constexpr double kHeight = 278.0;
constexpr double kLeft = 52.0;
constexpr double kRight = 12.0;
constexpr double kTop = 30.0;
constexpr double kBottom = 40.0;

// Of the theme (daemon/dashboard/page/theme.css); after them the same again, dashed, then dotted.
constexpr std::array<const char*, 7> kInks{"--blue", "--red", "--green", "--pink", "--orange", "--sky", "--violet"};
struct Dash {
  const char* css;
  const char* svg;
};
constexpr std::array<Dash, 3> kDashes{{{"solid", "none"}, {"dashed", "6 4"}, {"dotted", "2 3"}}};

const char* ink_of(std::size_t line) { return kInks[line % kInks.size()]; }
const Dash& dash_of(std::size_t line) { return kDashes[line / kInks.size() % kDashes.size()]; }

struct Extent {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();
  void take(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
  [[nodiscard]] Axis axis() const { return low <= high ? axis_for(low, high) : Axis{}; }
  /// Ends where the data end: time goes no further.
  [[nodiscard]] Axis ending_axis() const {
    Axis answer = axis();
    if (low < high) answer.high = high;
    return answer;
  }
};

std::string number(double value) { return text_of(std::round(100.0 * value) / 100.0); }

class Frame {
 public:
  Frame(const Axis& x, const Axis& y) : x_{x}, y_{y} {}
  [[nodiscard]] double across(double x) const {
    return kLeft + (x - x_.low) / (x_.high - x_.low) * (kWidth - kLeft - kRight);
  }
  [[nodiscard]] double down(double y) const {
    return kHeight - kBottom - (y - y_.low) / (y_.high - y_.low) * (kHeight - kTop - kBottom);
  }
  [[nodiscard]] std::string axes() const {
    std::string svg;
    for (int i = 0; x_.low + i * x_.step <= x_.high + 0.01 * x_.step; ++i) {
      const double x = x_.low + i * x_.step;
      svg += line(x, y_.low, x, y_.high) + label(across(x), kHeight - kBottom + 16.0, "middle", tick(x, x_));
    }
    for (int i = 0; y_.low + i * y_.step <= y_.high + 0.01 * y_.step; ++i) {
      const double y = y_.low + i * y_.step;
      svg += line(x_.low, y, x_.high, y) + label(kLeft - 6.0, down(y) + 4.0, "end", tick(y, y_));
    }
    return svg;
  }
  [[nodiscard]] std::string diagonal() const {
    const double low = std::max(x_.low, y_.low);
    const double high = std::min(x_.high, y_.high);
    return low < high ? line(low, low, high, high) : "";
  }
  /// What page/report.js leads back from pixels to values by.
  [[nodiscard]] std::string attributes() const {
    return " data-x=\"" + text_of(x_.low) + " " + text_of(x_.high) + "\" data-y=\"" + text_of(y_.low) + " " +
           text_of(y_.high) + "\" data-plot=\"" + text_of(kLeft) + " " + text_of(kTop) + " " +
           text_of(kWidth - kRight) + " " + text_of(kHeight - kBottom) + "\"";
  }
  [[nodiscard]] static std::string label(double across, double down, const char* anchor, const std::string& text) {
    return "<text x=\"" + number(across) + "\" y=\"" + number(down) + "\" text-anchor=\"" + anchor + "\">" +
           escaped(text) + "</text>\n";
  }

 private:
  [[nodiscard]] static std::string tick(double value, const Axis& axis) {
    return text_of(std::abs(value) < 1e-9 * axis.step ? 0.0 : value);
  }
  [[nodiscard]] std::string line(double x1, double y1, double x2, double y2) const {
    return "<line class=\"grid\" x1=\"" + number(across(x1)) + "\" y1=\"" + number(down(y1)) + "\" x2=\"" +
           number(across(x2)) + "\" y2=\"" + number(down(y2)) + "\"/>\n";
  }
  Axis x_;
  Axis y_;
};

std::string polyline_of(const Series& series, const Frame& frame, std::size_t line) {
  std::string points;
  for (const auto& [x, y] : series.points) {
    if (!std::isfinite(x) || !std::isfinite(y)) continue;
    points += number(frame.across(x)) + "," + number(frame.down(y)) + " ";
  }
  return "<polyline style=\"stroke:var(" + std::string{ink_of(line)} + ")\" stroke-dasharray=\"" + dash_of(line).svg +
         "\" points=\"" + points + "\"/>\n";
}

std::string key_of(const Series& series, std::size_t line) {
  return "<span style=\"--ink:var(" + std::string{ink_of(line)} + ");--dash:" + dash_of(line).css + "\">" +
         escaped(series.name) + "<output></output></span>";
}

Frame frame_of(const Chart& chart) {
  Extent x;
  Extent y;
  for (const Series& series : chart.series) {
    for (const auto& [px, py] : series.points) {
      if (!std::isfinite(px) || !std::isfinite(py)) continue;
      x.take(px);
      y.take(py);
    }
  }
  return {x.ending_axis(), y.axis()};
}

}  // namespace

Axis axis_for(double low, double high) {
  constexpr double kNearZero = 0.3;  // of the data's largest: an axis from 0 wastes little
  constexpr double kParts = 5.0;
  if (low >= 0.0 && low <= kNearZero * high) low = 0.0;
  if (high <= 0.0 && high >= kNearZero * low) high = 0.0;
  if (!(high > low)) {
    const double around = low == 0.0 ? 0.5 : 0.1 * std::abs(low);
    low -= around;
    high += around;
  }
  const double rough = (high - low) / kParts;
  const double power = std::pow(10.0, std::floor(std::log10(rough)));
  const double share = rough / power;
  const double step = power * (share < 1.5 ? 1.0 : share < 3.0 ? 2.0 : share < 7.0 ? 5.0 : 10.0);
  return {std::floor(low / step + 1e-9) * step, std::ceil(high / step - 1e-9) * step, step};
}

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

std::string figure_of(const Chart& chart) {
  const Frame frame = frame_of(chart);
  std::string html = "<figure class=\"chart\"><figcaption>" + escaped(chart.title) +
                     "<small><output></output></small></figcaption>\n<div class=\"keys\">";
  for (std::size_t i = 0; i < chart.series.size(); ++i) html += key_of(chart.series[i], i);
  html += "</div>\n<svg viewBox=\"0 0 " + text_of(kWidth) + " " + text_of(kHeight) +
          "\" tabindex=\"0\" role=\"img\" aria-label=\"" + escaped(chart.title + ": " + chart.y + " over " + chart.x) +
          "\"" + frame.attributes() + ">\n";
  html += frame.axes();
  if (chart.with_diagonal) html += frame.diagonal();
  for (std::size_t i = 0; i < chart.series.size(); ++i) html += polyline_of(chart.series[i], frame, i);
  html += "<line class=\"instant\" y1=\"" + text_of(kTop) + "\" y2=\"" + text_of(kHeight - kBottom) + "\"/>\n";
  html += Frame::label(4.0, 13.0, "start", chart.y);
  html += Frame::label(0.5 * (kLeft + kWidth - kRight), kHeight - 6.0, "middle", chart.x);
  return html + "</svg></figure>\n";
}

}  // namespace deltamap::reports
