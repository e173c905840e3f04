// SPDX-License-Identifier: Apache-2.0
#include "mapping/merge/shift_correlation.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>

namespace deltamap::mapping::merge {
namespace {

constexpr int kApart_pixels = 3;

float radius_of(const LocalCells& local) {
  float most2 = 0.0F;
  for (const auto* points : {&local.occupied(), &local.free()}) {
    for (const PointInCells& point : *points) most2 = std::max(most2, point.x * point.x + point.y * point.y);
  }
  return std::sqrt(most2);
}

/// Contour pixels count 1, free ones together as much as these with the opposite sign: a picture without a mean, on
/// which contour on contour and free on free gain, contour on free loses, and unknown is silent.
void balance(cv::Mat& picture) {
  const double contour = cv::countNonZero(picture > 0.0F);
  const double free = cv::countNonZero(picture < 0.0F);
  if (free > 0.0) picture.setTo(-contour / free, picture < 0.0F);
}

}  // namespace

struct ShiftCorrelation::State {
  const LocalCells& local;
  int cells_per_pixel = 1;
  int margin = 0;  // pixels around the map: the local map's middle may lie outside
  int size = 0;    // of the square pictures
  cv::Mat map_transform;
  std::vector<PointInCells> free;  // thinned to about one a pixel

  explicit State(const LocalCells& local_cells) : local{local_cells} {}

  void draw(cv::Mat& picture, float column, float row, float value) const {
    const int x = static_cast<int>(std::floor(column / static_cast<float>(cells_per_pixel)));
    const int y = static_cast<int>(std::floor(row / static_cast<float>(cells_per_pixel)));
    picture.at<float>((y + size) % size, (x + size) % size) = value;
  }
};

ShiftCorrelation::ShiftCorrelation(const OccupancyGrid& map, const LocalCells& local, int most_pixels)
    : state_{std::make_unique<State>(local)} {
  State& s = *state_;
  const int radius_cells = static_cast<int>(std::ceil(radius_of(local))) + 1;
  const int cells = std::max(map.width(), map.height()) + 2 * radius_cells;
  s.cells_per_pixel = std::max(1, (cells + most_pixels - 1) / most_pixels);
  s.size = cv::getOptimalDFTSize(cells / s.cells_per_pixel + 2);

  cv::Mat picture = cv::Mat::zeros(s.size, s.size, CV_32F);
  for (std::size_t i = 0; i < map.cells().size(); ++i) {
    if (map.cells()[i] != CellState::kFree) continue;
    const Cell cell = map.geometry().cell_of(i);
    s.draw(picture, static_cast<float>(cell.column) + 0.5F, static_cast<float>(cell.row) + 0.5F, -1.0F);
  }
  for (const Cell& cell : contour_cells(map)) {
    s.draw(picture, static_cast<float>(cell.column) + 0.5F, static_cast<float>(cell.row) + 0.5F, 1.0F);
  }
  balance(picture);
  cv::dft(picture, s.map_transform);
}

ShiftCorrelation::~ShiftCorrelation() = default;

int ShiftCorrelation::cells_per_pixel() const { return state_->cells_per_pixel; }

std::vector<CellMotion> ShiftCorrelation::best_shifts(double turn_rad, int n) const {
  const State& s = *state_;
  const auto cosine = static_cast<float>(std::cos(turn_rad));
  const auto sine = static_cast<float>(std::sin(turn_rad));
  cv::Mat picture = cv::Mat::zeros(s.size, s.size, CV_32F);
  const auto draw_all = [&](const std::vector<PointInCells>& points, float value) {
    for (const PointInCells& p : points) s.draw(picture, cosine * p.x - sine * p.y, sine * p.x + cosine * p.y, value);
  };
  draw_all(s.local.free(), -1.0F);
  draw_all(s.local.contour(), 1.0F);
  balance(picture);

  cv::Mat transform;
  cv::dft(picture, transform);
  cv::mulSpectrums(s.map_transform, transform, transform, 0, true);
  cv::Mat scores;
  cv::dft(transform, scores, cv::DFT_INVERSE | cv::DFT_REAL_OUTPUT);

  std::vector<CellMotion> best;
  for (int i = 0; i < n; ++i) {
    double score = 0.0;
    cv::Point at;
    cv::minMaxLoc(scores, nullptr, &score, nullptr, &at);
    if (score <= 0.0) break;
    // Shifts are circular: those in the upper part of the picture lie left of or below the map.
    const int map_side = s.size * 3 / 4;
    const int x = at.x > map_side ? at.x - s.size : at.x;
    const int y = at.y > map_side ? at.y - s.size : at.y;
    best.push_back({turn_rad, (x + 0.0) * s.cells_per_pixel, (y + 0.0) * s.cells_per_pixel});
    for (int dy = -kApart_pixels; dy <= kApart_pixels; ++dy) {
      for (int dx = -kApart_pixels; dx <= kApart_pixels; ++dx) {
        scores.at<float>((at.y + dy + s.size) % s.size, (at.x + dx + s.size) % s.size) = 0.0F;
      }
    }
  }
  return best;
}

}  // namespace deltamap::mapping::merge
