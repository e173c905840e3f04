// SPDX-License-Identifier: Apache-2.0
#include "tool/picture/scene.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

#include "core/grid_patch.hpp"
#include "tool/picture/changed_places.hpp"
#include "tool/picture/ink.hpp"
#include "tool/picture/legend.hpp"

namespace deltamap::tool::picture {
namespace {

constexpr int kMargin_cells = 4;
constexpr int kPage_px = 700;        // the longer side of a map that chooses its own scale is at least so long
constexpr int kLeastWidth_px = 320;  // so that a row of the legend fits
constexpr int kTitle_px = 26;
constexpr std::int64_t kMostPixels = 64'000'000;
constexpr double kTogether_m = 0.3;  // changed cells so close are one place
constexpr int kSmall_px = 26;        // a place with shorter sides is ringed
constexpr double kRobot_m = 0.25;    // radius

CellBox shown_box(const Scene& scene) {
  if (scene.shown) return *scene.shown;
  CellBox known = known_box(scene.map);
  if (scene.before != nullptr) known = united(known, known_box(*scene.before));
  return known.empty() ? scene.map.box() : grown(known, kMargin_cells, scene.map.geometry());
}

const Ink& ink_of(CellState before, CellState after) {
  const bool is_same = before == after;
  if (after == CellState::kOccupied) return is_same ? kOccupied : kNewlyOccupied;
  if (after == CellState::kFree) return is_same ? kFree : kNewlyFree;
  return is_same ? kUnknown : kForgotten;
}

/// From cells and points to pixels.
class View {
 public:
  View(const Scene& scene, CellBox box)
      : geometry_{scene.map.geometry()}, box_{box}, cell_px_{std::max(1, scene.cell_pixels)} {
    const int longer = std::max(box.width(), box.height());
    if (scene.cell_pixels == 0) cell_px_ = std::clamp((kPage_px + longer - 1) / longer, 1, 16);
    if (std::int64_t{box.width()} * box.height() * cell_px_ * cell_px_ > kMostPixels) {
      throw std::runtime_error("the picture would have more than " + std::to_string(kMostPixels / 1'000'000) +
                               " million pixels");
    }
  }
  [[nodiscard]] int cell_px() const { return cell_px_; }
  [[nodiscard]] double px_per_m() const { return cell_px_ / geometry_.resolution_m; }
  [[nodiscard]] cv::Size size() const { return {box_.width() * cell_px_, box_.height() * cell_px_}; }
  [[nodiscard]] cv::Rect cell(Cell cell) const {
    return {(cell.column - box_.first.column) * cell_px_, (box_.last.row - 1 - cell.row) * cell_px_, cell_px_,
            cell_px_};
  }
  [[nodiscard]] cv::Point2d point(const Point2& in_map) const {
    const Point2 cells = (in_map - geometry_.origin) / geometry_.resolution_m;
    return {(cells.x() - box_.first.column) * cell_px_, (box_.last.row - cells.y()) * cell_px_};
  }

 private:
  GridGeometry geometry_;
  CellBox box_;
  int cell_px_;
};

void draw_cells(cv::Mat& canvas, const Scene& scene, const View& view, const CellBox& box) {
  for (int row = box.first.row; row < box.last.row; ++row) {
    for (int column = box.first.column; column < box.last.column; ++column) {
      const Cell cell{column, row};
      if (!scene.map.geometry().contains(cell)) continue;
      const CellState after = scene.map[cell];
      canvas(view.cell(cell)) = colour(ink_of(scene.before != nullptr ? (*scene.before)[cell] : after, after));
    }
  }
}

void draw_rings(cv::Mat& canvas, const std::vector<CellBox>& places, const View& view, const CellBox& box) {
  for (const CellBox& place : places) {
    const int longer = std::max(place.width(), place.height()) * view.cell_px();
    if (longer >= kSmall_px || !box.contains(place.first)) continue;
    const cv::Rect low = view.cell(place.first);
    const cv::Rect high = view.cell({place.last.column - 1, place.last.row - 1});
    draw_ring(canvas, (low.tl() + low.br() + high.tl() + high.br()) / 4, std::max(11, longer / 2 + 7));
  }
}

void draw_path(cv::Mat& canvas, const std::vector<Point2>& path, const View& view) {
  std::vector<cv::Point> points;
  for (const Point2& point : path) points.push_back(view.point(point));
  cv::polylines(canvas, points, false, colour(kPath), 2, cv::LINE_AA);
}

void draw_scan(cv::Mat& canvas, const std::vector<Point2>& ends, const View& view) {
  const int radius = std::clamp(view.cell_px(), 1, 3);
  for (const Point2& end : ends) cv::circle(canvas, view.point(end), radius, colour(kScan), cv::FILLED, cv::LINE_AA);
}

std::vector<Key> keys_of(const Scene& scene, bool has_rings) {
  std::vector<Key> keys{
      {Sign::kCell, kOccupied, "occupied"}, {Sign::kCell, kFree, "free"}, {Sign::kCell, kUnknown, "unknown"}};
  if (scene.before != nullptr) {
    keys.push_back({Sign::kCell, kNewlyOccupied, "newly occupied"});
    keys.push_back({Sign::kCell, kNewlyFree, "newly free"});
    keys.push_back({Sign::kCell, kForgotten, "forgotten"});
  }
  if (has_rings) keys.push_back({Sign::kCircle, kRing, "small change"});
  if (scene.path) keys.push_back({Sign::kLine, kPath, "path"});
  if (!scene.scan_ends.empty()) keys.push_back({Sign::kDot, kScan, "scan"});
  if (scene.robot) keys.push_back({Sign::kArrow, kRobot, "robot"});
  return keys;
}

cv::Mat drawn_map(const Scene& scene, const View& view, const CellBox& box) {
  cv::Mat canvas(view.size(), CV_8UC3, colour(kUnknown));
  draw_cells(canvas, scene, view, box);
  if (scene.path) draw_path(canvas, *scene.path, view);
  draw_scan(canvas, scene.scan_ends, view);
  if (scene.before != nullptr) {
    const int reach = std::max(1, static_cast<int>(kTogether_m / scene.map.resolution_m()));
    draw_rings(canvas, changed_places(changes_between(*scene.before, scene.map), reach), view, box);
  }
  if (scene.robot) {
    draw_robot(canvas, view.point(scene.robot->position()), scene.robot->theta,
               std::max(7.0, kRobot_m * view.px_per_m()));
  }
  return canvas;
}

Raster raster_of(const cv::Mat& canvas) {
  Raster raster{static_cast<std::size_t>(canvas.cols), static_cast<std::size_t>(canvas.rows), {}};
  raster.rgb.reserve(3 * raster.width * raster.height);
  for (int row = 0; row < canvas.rows; ++row) {
    const auto* pixel = canvas.ptr<cv::Vec3b>(row);
    for (int column = 0; column < canvas.cols; ++column) {
      for (const int channel : {2, 1, 0}) raster.rgb.push_back(pixel[column][channel]);
    }
  }
  return raster;
}

}  // namespace

Raster drawn(const Scene& scene) {
  if (scene.before != nullptr && !(scene.before->geometry() == scene.map.geometry())) {
    throw std::runtime_error("the two maps differ in size, origin or resolution");
  }
  const CellBox box = shown_box(scene);
  const View view{scene, box};
  const cv::Mat map = drawn_map(scene, view, box);
  const int width = std::max(map.cols, kLeastWidth_px);
  const cv::Mat legend = drawn_legend(keys_of(scene, scene.before != nullptr), view.px_per_m(), width);
  const int title = scene.title.empty() ? 0 : kTitle_px;
  cv::Mat page(title + map.rows + legend.rows, width, CV_8UC3, colour(kPaper));
  if (title > 0) draw_text(page, scene.title, {10, 17});
  map.copyTo(page(cv::Rect{(width - map.cols) / 2, title, map.cols, map.rows}));
  legend.copyTo(page(cv::Rect{0, title + map.rows, legend.cols, legend.rows}));
  return raster_of(page);
}

Raster side_by_side(const Raster& left, const Raster& right) {
  constexpr std::size_t kGap_px = 10;
  Raster both{left.width + kGap_px + right.width, std::max(left.height, right.height), {}};
  both.rgb.assign(3 * both.width * both.height, 255);
  std::size_t from_x = 0;
  for (const Raster* one : {&left, &right}) {
    for (std::size_t y = 0; y < one->height; ++y) {
      const auto row = one->rgb.begin() + static_cast<std::ptrdiff_t>(3 * y * one->width);
      std::copy_n(row, 3 * one->width, both.rgb.begin() + static_cast<std::ptrdiff_t>(3 * (y * both.width + from_x)));
    }
    from_x += left.width + kGap_px;
  }
  return both;
}

}  // namespace deltamap::tool::picture
