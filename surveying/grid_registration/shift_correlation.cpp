// SPDX-License-Identifier: Apache-2.0
// Why the Fourier transform: scoring each of n shifts by n pixels costs n², by transforms n log n. Free space counts
// with the opposite sign, because contour alone would lie as well on any parallel wall.
#include "surveying/grid_registration/shift_correlation.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <opencv2/core.hpp>

namespace deltamap::surveying::grid_registration {
namespace {

constexpr int kApart_pixels = 3;
constexpr std::size_t kFreeCellsPerPixel = 2;  // of the local map's, enough to tell how free a pixel is

float radius_of(const mapping::merge::LocalCells& local) {
  float most2 = 0.0F;
  for (const auto* points : {&local.occupied(), &local.free()}) {
    for (const mapping::merge::PointInCells& point : *points)
      most2 = std::max(most2, point.x * point.x + point.y * point.y);
  }
  return std::sqrt(most2);
}

/// Where the parabola through a maximum and its neighbours has its top.
double between_pixels(double before, double top, double after) {
  const double bend = before - 2.0 * top + after;
  return bend < 0.0 ? std::clamp(0.5 * (before - after) / bend, -0.5, 0.5) : 0.0;
}

}  // namespace

/// Pictures are sums over the cells of a pixel: contour cells count +1, free ones together as much with the opposite
/// sign. A picture without a mean, on which contour on contour and free on free gain, contour on free loses, and
/// unknown is silent.
struct ShiftCorrelation::State {
  const mapping::merge::LocalCells& local;
  int cells_per_pixel = 1;
  int columns = 0;
  int rows = 0;
  int last_column = 0;  // shifts are circular: those beyond lie left of the map …
  int last_row = 0;     // … or below it
  std::vector<mapping::merge::PointInCells> free;
  cv::Mat map_transform;

  explicit State(const mapping::merge::LocalCells& local_cells) : local{local_cells} {}

  void place_best(const cv::Mat& scores, double turn_rad, int offset, int n,
                  std::vector<mapping::merge::CellMotion>& best) const;
};

ShiftCorrelation::ShiftCorrelation(const OccupancyGrid& map, std::span<const Cell> map_contour,
                                   const mapping::merge::LocalCells& local, int least_cells_per_pixel, int most_pixels)
    : state_{std::make_unique<State>(local)} {
  State& s = *state_;
  const int radius_cells = static_cast<int>(std::ceil(radius_of(local))) + 1;
  const int most_cells = std::max({map.width(), map.height(), radius_cells}) + radius_cells;
  s.cells_per_pixel = std::max(least_cells_per_pixel, (most_cells + most_pixels - 1) / most_pixels);
  const auto side = [&](int map_cells) {
    return cv::getOptimalDFTSize((std::max(map_cells, radius_cells) + radius_cells) / s.cells_per_pixel + 2);
  };
  s.columns = side(map.width());
  s.rows = side(map.height());
  s.last_column = (s.columns + map.width() / s.cells_per_pixel) / 2;
  s.last_row = (s.rows + map.height() / s.cells_per_pixel) / 2;

  cv::Mat picture = cv::Mat::zeros(s.rows, s.columns, CV_32F);
  const auto free_cells = static_cast<float>(count_of(map, CellState::kFree));
  const float free_value = -static_cast<float>(map_contour.size()) / std::max(1.0F, free_cells);
  for_each_known(map, [&](Cell cell, CellState state) {
    if (state == CellState::kFree)
      picture.at<float>(cell.row / s.cells_per_pixel, cell.column / s.cells_per_pixel) += free_value;
  });
  for (const Cell& cell : map_contour) {
    picture.at<float>(cell.row / s.cells_per_pixel, cell.column / s.cells_per_pixel) += 1.0F;
  }
  cv::dft(picture, s.map_transform);

  const auto per_pixel = static_cast<std::size_t>(s.cells_per_pixel) * static_cast<std::size_t>(s.cells_per_pixel);
  const std::size_t stride = std::max<std::size_t>(1, per_pixel / kFreeCellsPerPixel);
  for (std::size_t i = 0; i < local.free().size(); i += stride) s.free.push_back(local.free()[i]);
}

ShiftCorrelation::~ShiftCorrelation() = default;

int ShiftCorrelation::cells_per_pixel() const { return state_->cells_per_pixel; }

void ShiftCorrelation::State::place_best(const cv::Mat& scores, double turn_rad, int offset, int n,
                                         std::vector<mapping::merge::CellMotion>& best) const {
  cv::Mat left = scores.clone();
  for (int i = 0; i < n; ++i) {
    double score = 0.0;
    cv::Point at;
    cv::minMaxLoc(left, nullptr, &score, nullptr, &at);
    if (score <= 0.0) break;
    const auto score_at = [&](int dx, int dy) {
      return static_cast<double>(scores.at<float>((at.y + dy + rows) % rows, (at.x + dx + columns) % columns));
    };
    const double x =
        (at.x > last_column ? at.x - columns : at.x) + offset + between_pixels(score_at(-1, 0), score, score_at(1, 0));
    const double y =
        (at.y > last_row ? at.y - rows : at.y) + offset + between_pixels(score_at(0, -1), score, score_at(0, 1));
    best.push_back({turn_rad, x * cells_per_pixel, y * cells_per_pixel});
    for (int dy = -kApart_pixels; dy <= kApart_pixels; ++dy) {
      for (int dx = -kApart_pixels; dx <= kApart_pixels; ++dx) {
        left.at<float>((at.y + dy + rows) % rows, (at.x + dx + columns) % columns) = 0.0F;
      }
    }
  }
}

std::vector<mapping::merge::CellMotion> ShiftCorrelation::best_shifts(double turn_rad, int n) const {
  const State& s = *state_;
  const float to_pixels = 1.0F / static_cast<float>(s.cells_per_pixel);
  const float cosine = to_pixels * static_cast<float>(std::cos(turn_rad));
  const float sine = to_pixels * static_cast<float>(std::sin(turn_rad));
  cv::Mat picture = cv::Mat::zeros(s.rows, s.columns, CV_32F);
  const auto draw = [&](const std::vector<mapping::merge::PointInCells>& points, float value) {
    for (const mapping::merge::PointInCells& p : points) {
      int x = rounded_down(cosine * p.x - sine * p.y);
      int y = rounded_down(sine * p.x + cosine * p.y);
      x += x < 0 ? s.columns : 0;
      y += y < 0 ? s.rows : 0;
      // Of a local map much larger than the map, what lies farther than the picture fits nowhere.
      if (x >= 0 && y >= 0 && x < s.columns && y < s.rows) picture.at<float>(y, x) += value;
    }
  };
  const auto contour_count = static_cast<float>(s.local.contour().size());
  draw(s.free, -contour_count / std::max(1.0F, static_cast<float>(s.free.size())));
  draw(s.local.contour(), 1.0F);

  cv::Mat transform;
  cv::Mat product;
  cv::Mat scores;
  std::vector<mapping::merge::CellMotion> best;
  cv::dft(picture, transform);
  cv::mulSpectrums(s.map_transform, transform, product, 0, true);
  cv::dft(product, scores, cv::DFT_INVERSE | cv::DFT_REAL_OUTPUT);
  s.place_best(scores, turn_rad, 0, n, best);
  // Half a turn takes pixel i to -1 - i: the correlation becomes a convolution, one pixel on.
  cv::mulSpectrums(s.map_transform, transform, product, 0, false);
  cv::dft(product, scores, cv::DFT_INVERSE | cv::DFT_REAL_OUTPUT);
  s.place_best(scores, turn_rad + std::numbers::pi, 1, n, best);
  return best;
}

}  // namespace deltamap::surveying::grid_registration
