// SPDX-License-Identifier: Apache-2.0
#include "tool/picture/canvas.hpp"

#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <utility>

namespace deltamap::tool::picture {
namespace {

constexpr int kFont = cv::FONT_HERSHEY_SIMPLEX;
constexpr double kFontScale = 0.45;

/// OpenCV has blue first.
cv::Scalar colour(const Ink& ink) { return {double(ink[2]), double(ink[1]), double(ink[0])}; }

cv::Point point(Pixel pixel) { return cv::Point2d{pixel.x, pixel.y}; }

}  // namespace

struct Canvas::State {
  cv::Mat mat;
};

Canvas::Canvas(int width, int height, const Ink& paper)
    : state_{std::make_unique<State>(State{cv::Mat(height, width, CV_8UC3, colour(paper))})} {}
Canvas::~Canvas() = default;
Canvas::Canvas(Canvas&&) noexcept = default;
Canvas& Canvas::operator=(Canvas&&) noexcept = default;

int Canvas::width() const { return state_->mat.cols; }
int Canvas::height() const { return state_->mat.rows; }

void Canvas::fill(int left, int top, int width, int height, const Ink& ink) {
  const cv::Rect seen = cv::Rect{left, top, width, height} & cv::Rect{0, 0, state_->mat.cols, state_->mat.rows};
  if (!seen.empty()) state_->mat(seen) = colour(ink);
}

void Canvas::draw_line(const std::vector<Pixel>& points, const Ink& ink, int thickness) {
  std::vector<cv::Point> corners;
  for (const Pixel& pixel : points) corners.push_back(point(pixel));
  cv::polylines(state_->mat, corners, false, colour(ink), thickness, cv::LINE_AA);
}

void Canvas::draw_disc(Pixel middle, int radius, const Ink& ink) {
  cv::circle(state_->mat, point(middle), radius, colour(ink), cv::FILLED, cv::LINE_AA);
}

void Canvas::draw_ring(Pixel middle, int radius) {
  cv::circle(state_->mat, point(middle), radius, colour(kPaper), 4, cv::LINE_AA);
  cv::circle(state_->mat, point(middle), radius, colour(kRing), 2, cv::LINE_AA);
}

void Canvas::draw_robot(Pixel middle, double heading_rad, double radius) {
  draw_disc(middle, static_cast<int>(std::lround(radius)), kRobot);
  std::array<cv::Point, 3> tip;
  const std::array<std::pair<double, double>, 3> corners{{{0.8, 0.0}, {0.75, 2.25}, {0.75, -2.25}}};  // radius, bearing
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const auto [share, bearing] = corners[i];
    tip[i] = point({middle.x + radius * share * std::cos(heading_rad + bearing),
                    middle.y - radius * share * std::sin(heading_rad + bearing)});
  }
  cv::fillConvexPoly(state_->mat, tip, colour(kPaper), cv::LINE_AA);
}

void Canvas::draw_text(const std::string& text, int left, int base) {
  cv::putText(state_->mat, text, {left, base}, kFont, kFontScale, colour(kText), 1, cv::LINE_AA);
}

int Canvas::text_width(const std::string& text) {
  int base = 0;
  return cv::getTextSize(text, kFont, kFontScale, 1, &base).width;
}

void Canvas::paste(const Canvas& other, int left, int top, int rows) {
  other.state_->mat.rowRange(0, rows).copyTo(state_->mat(cv::Rect{left, top, other.width(), rows}));
}

Raster Canvas::raster() const {
  const cv::Mat& mat = state_->mat;
  Raster raster{static_cast<std::size_t>(mat.cols), static_cast<std::size_t>(mat.rows), {}};
  raster.rgb.reserve(3 * raster.width * raster.height);
  for (int row = 0; row < mat.rows; ++row) {
    const auto* pixel = mat.ptr<cv::Vec3b>(row);
    for (int column = 0; column < mat.cols; ++column) {
      for (const int channel : {2, 1, 0}) raster.rgb.push_back(pixel[column][channel]);
    }
  }
  return raster;
}

}  // namespace deltamap::tool::picture
