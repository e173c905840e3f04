// SPDX-License-Identifier: Apache-2.0
#include "tool/picture/scene.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/grid/grid_patch.hpp"
#include "tool/picture/canvas.hpp"
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
constexpr int kDoubted_px = 14;      // radius
constexpr double kRobot_m = 0.25;    // radius

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
  [[nodiscard]] int width() const { return box_.width() * cell_px_; }
  [[nodiscard]] int height() const { return box_.height() * cell_px_; }
  /// The upper left corner of a cell.
  [[nodiscard]] int left_of(Cell cell) const { return (cell.column - box_.first.column) * cell_px_; }
  [[nodiscard]] int top_of(Cell cell) const { return (box_.last.row - 1 - cell.row) * cell_px_; }
  [[nodiscard]] Pixel middle_of(const CellBox& cells) const {
    return {0.5 * (left_of(cells.first) + left_of(cells.last)),
            0.5 * (top_of(cells.first) + top_of(cells.last)) + cell_px_};
  }
  [[nodiscard]] Pixel pixel(const Point2& in_map) const {
    const Point2 cells = (in_map - geometry_.origin) / geometry_.resolution_m;
    return {(cells.x() - box_.first.column) * cell_px_, (box_.last.row - cells.y()) * cell_px_};
  }

 private:
  GridGeometry geometry_;
  CellBox box_;
  int cell_px_;
};

void draw_cells(Canvas& canvas, const Scene& scene, const View& view, const CellBox& box) {
  for (int row = box.first.row; row < box.last.row; ++row) {
    for (int column = box.first.column; column < box.last.column; ++column) {
      const Cell cell{column, row};
      if (!scene.map.geometry().contains(cell)) continue;
      const CellState after = scene.map[cell];
      const Ink& ink = ink_of(scene.before != nullptr ? (*scene.before)[cell] : after, after);
      canvas.fill(view.left_of(cell), view.top_of(cell), view.cell_px(), view.cell_px(), ink);
    }
  }
}

void draw_rings(Canvas& canvas, const std::vector<CellBox>& places, const View& view, const CellBox& box) {
  for (const CellBox& place : places) {
    const int longer = std::max(place.width(), place.height()) * view.cell_px();
    if (longer >= kSmall_px || !box.contains(place.first)) continue;
    canvas.draw_ring(view.middle_of(place), std::max(11, longer / 2 + 7));
  }
}

void draw_path(Canvas& canvas, const std::vector<Point2>& path, const View& view) {
  std::vector<Pixel> pixels;
  pixels.reserve(path.size());
  for (const Point2& point : path) pixels.push_back(view.pixel(point));
  canvas.draw_line(pixels, kPath);
}

void draw_scan(Canvas& canvas, const std::vector<Point2>& ends, const View& view) {
  const int radius = std::clamp(view.cell_px(), 1, 3);
  for (const Point2& end : ends) canvas.draw_disc(view.pixel(end), radius, kScan);
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
  if (!scene.doubted.empty()) keys.push_back({Sign::kCircle, kRing, "contradiction"});
  if (scene.path) keys.push_back({Sign::kLine, kPath, "path"});
  if (!scene.scan_ends.empty()) keys.push_back({Sign::kDot, kScan, "scan"});
  if (scene.robot) keys.push_back({Sign::kArrow, kRobot, "robot"});
  return keys;
}

Canvas drawn_map(const Scene& scene, const View& view, const CellBox& box) {
  Canvas canvas{view.width(), view.height(), kUnknown};
  draw_cells(canvas, scene, view, box);
  if (scene.path) draw_path(canvas, *scene.path, view);
  draw_scan(canvas, scene.scan_ends, view);
  if (scene.before != nullptr) {
    const int reach = std::max(1, static_cast<int>(kTogether_m / scene.map.resolution_m()));
    draw_rings(canvas, changed_places(changes_between(*scene.before, scene.map), reach), view, box);
  }
  for (const Point2& place : scene.doubted) canvas.draw_ring(view.pixel(place), kDoubted_px);
  if (scene.robot) {
    const double radius = std::max(7.0, kRobot_m * view.px_per_m());
    canvas.draw_robot(view.pixel(scene.robot->position()), scene.robot->theta, radius);
  }
  return canvas;
}

}  // namespace

CellBox known_part(const OccupancyGrid& map, const OccupancyGrid* before) {
  CellBox known = known_box(map);
  if (before != nullptr) known = united(known, known_box(*before));
  return known.empty() ? map.box() : grown(known, kMargin_cells, map.geometry());
}

Raster drawn(const Scene& scene) {
  if (scene.before != nullptr && !(scene.before->geometry() == scene.map.geometry())) {
    throw std::runtime_error("the two maps differ in size, origin or resolution");
  }
  const CellBox box = scene.shown ? *scene.shown : known_part(scene.map, scene.before);
  const View view{scene, box};
  const int width = std::max(view.width(), kLeastWidth_px);
  const Legend legend = drawn_legend(keys_of(scene, scene.before != nullptr), view.px_per_m(), width);
  const int title = scene.title.empty() ? 0 : kTitle_px;
  Canvas page{width, title + view.height() + legend.rows, kPaper};
  if (title > 0) page.draw_text(scene.title, 10, 17);
  page.paste(drawn_map(scene, view, box), (width - view.width()) / 2, title, view.height());
  page.paste(legend.canvas, 0, title + view.height(), legend.rows);
  return page.raster();
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
