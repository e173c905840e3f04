// SPDX-License-Identifier: Apache-2.0
#include "experiments/verdict/path_search.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/geometry/angle.hpp"

namespace deltamap::experiments {
namespace {

constexpr double kFirst_m = 0.4;  // side of the first boxes
constexpr double kFirst_rad = radians(5.0);
constexpr double kLast_m = 0.05;         // boxes of this side are climbed in, not split
constexpr float kCellCorner_m = 0.075F;  // a table tells from middle to middle of its cells: two half diagonals
constexpr float kShortOfEnd_m = 0.3F;    // what lies so near the end is the end
constexpr float kStep_m = 0.025F;        // along a beam, at least
constexpr float kInObstacle_m = 0.02F;
constexpr float kOffFloor_m = 0.1F;
constexpr double kWorthClimbing = 0.1;  // of all pieces, above the best known

bool goes_through(const MapDistances& map, float x, float y, float end_x, float end_y) {
  const float length = std::hypot(end_x - x, end_y - y);
  const float along_x = (end_x - x) / length;
  const float along_y = (end_y - y) / length;
  for (float way = 0.0F; way < length - kShortOfEnd_m;) {
    const float clear = map.to_obstacle_m(x + way * along_x, y + way * along_y);
    if (clear < kInObstacle_m) return true;
    way += std::max(kStep_m, clear - kCellCorner_m);
  }
  return false;
}

}  // namespace

struct PathSearch::Turn {
  explicit Turn(const Pose2& pose)
      : x{static_cast<float>(pose.x)},
        y{static_cast<float>(pose.y)},
        cosine{static_cast<float>(std::cos(pose.theta))},
        sine{static_cast<float>(std::sin(pose.theta))} {}
  [[nodiscard]] float x_of(float ahead, float left) const { return x + cosine * ahead - sine * left; }
  [[nodiscard]] float y_of(float ahead, float left) const { return y + sine * ahead + cosine * left; }
  float x, y, cosine, sine;
};

bool PathSearch::explains(const SeenPath::Beam& beam, const Turn& turn) const {
  const float end_x = turn.x_of(beam.end_x, beam.end_y);
  const float end_y = turn.y_of(beam.end_x, beam.end_y);
  const float from_x = turn.x_of(beam.from_x, beam.from_y);
  const float from_y = turn.y_of(beam.from_x, beam.from_y);
  return map_.to_obstacle_m(end_x, end_y) <= static_cast<float>(params_.fits_within_m) &&
         map_.to_floor_m(from_x, from_y) <= kOffFloor_m && !goes_through(map_, from_x, from_y, end_x, end_y);
}

bool PathSearch::explains(const SeenPath::Beam& beam, const Pose2& map_from_middle) const {
  return explains(beam, Turn{map_from_middle});
}

double PathSearch::unexplained(const Pose2& map_from_middle) const {
  const Turn turn{map_from_middle};
  float misfit = 0.0F;
  for (const SeenPath::Beam& beam : path_.beams) {
    if (!explains(beam, turn)) misfit += beam.weight;
  }
  return static_cast<double>(misfit);
}

/// A beam is a misfit for all poses of a box if it is one at the middle by more than the box can move its points.
double PathSearch::least_unexplained(const Box& box, double limit) const {
  ++judged_;
  const Turn turn{box.middle};
  const float shift = static_cast<float>(std::numbers::sqrt2 * box.half_m) + kCellCorner_m;
  const auto turned = static_cast<float>(box.half_rad);
  const float end_slack = shift + static_cast<float>(params_.fits_within_m);
  const auto stop = static_cast<float>(limit);
  float misfit = 0.0F;
  for (const SeenPath::Beam& beam : path_.beams) {
    const float end_x = turn.x_of(beam.end_x, beam.end_y);
    const float end_y = turn.y_of(beam.end_x, beam.end_y);
    bool fits = map_.to_obstacle_m(end_x, end_y) <= end_slack + turned * beam.end_lever;
    if (fits) {
      const float from_x = turn.x_of(beam.from_x, beam.from_y);
      const float from_y = turn.y_of(beam.from_x, beam.from_y);
      const float slack = shift + turned * std::max(beam.end_lever, beam.from_lever);
      fits = map_.to_floor_m(from_x, from_y) <= kOffFloor_m + shift + turned * beam.from_lever &&
             map_.to_floor_m(0.5F * (from_x + end_x), 0.5F * (from_y + end_y)) <= kCellCorner_m + slack;
    }
    if (fits) continue;
    misfit += beam.weight;
    if (misfit >= stop) break;
  }
  return static_cast<double>(misfit);
}

std::vector<PathSearch::Box> PathSearch::first_boxes(double most) const {
  const GridGeometry& g = map_.geometry();
  const int columns = static_cast<int>(std::ceil(g.width * g.resolution_m / kFirst_m));
  const int rows = static_cast<int>(std::ceil(g.height * g.resolution_m / kFirst_m));
  const int headings = static_cast<int>(std::lround(2.0 * std::numbers::pi / kFirst_rad));
  std::vector<Box> boxes;
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      const double x = g.origin.x() + (column + 0.5) * kFirst_m;
      const double y = g.origin.y() + (row + 0.5) * kFirst_m;
      const bool floor = static_cast<double>(map_.to_floor_m(static_cast<float>(x), static_cast<float>(y))) <=
                         0.5 * std::numbers::sqrt2 * kFirst_m;
      if (!floor) continue;
      for (int i = 0; i < headings; ++i) {
        Box box{{x, y, wrapped_angle(i * kFirst_rad)}, 0.5 * kFirst_m, 0.5 * kFirst_rad, 0.0};
        box.least = least_unexplained(box, most);
        if (box.least < most) boxes.push_back(box);
      }
    }
  }
  return boxes;
}

bool PathSearch::is_wrong(const Pose2& pose) const {
  return distance_between(pose, path_.map_from_middle) > params_.wrong_m ||
         std::abs(turn_between(pose.theta, path_.map_from_middle.theta)) > params_.wrong_rad;
}

bool PathSearch::is_all_right(const Box& box) const {
  return distance_between(box.middle, path_.map_from_middle) + std::numbers::sqrt2 * box.half_m <= params_.wrong_m &&
         std::abs(turn_between(box.middle.theta, path_.map_from_middle.theta)) + box.half_rad <= params_.wrong_rad;
}

PathSearch::Rival PathSearch::climbed(const Pose2& from) const {
  Rival best{from, unexplained(from)};
  double step_m = 0.5 * kLast_m;
  double step_rad = radians(0.3);
  for (int round = 0; round < 12; ++round) {
    const Rival before = best;
    for (const auto& [x, y, turn] :
         std::array<std::array<double, 3>, 6>{{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}}}) {
      const Pose2& p = before.map_from_middle;
      const Pose2 next{p.x + x * step_m, p.y + y * step_m, wrapped_angle(p.theta + turn * step_rad)};
      if (!is_wrong(next)) continue;
      if (const double misfit = unexplained(next); misfit < best.unexplained) best = {next, misfit};
    }
    if (best.unexplained < before.unexplained) continue;
    step_m *= 0.5;
    step_rad *= 0.5;
    if (step_m < 0.005) break;
  }
  return best;
}

void PathSearch::split(const Box& box, double most, std::vector<Box>& open) const {
  const auto first = static_cast<std::ptrdiff_t>(open.size());
  const double half_m = 0.5 * box.half_m;
  const double half_rad = 0.5 * box.half_rad;
  for (int i = 0; i < 8; ++i) {
    const auto side = [&](int bit) { return (i >> bit & 1) != 0 ? 1.0 : -1.0; };
    Box part{{box.middle.x + side(0) * half_m, box.middle.y + side(1) * half_m,
              wrapped_angle(box.middle.theta + side(2) * half_rad)},
             half_m,
             half_rad,
             0.0};
    if (is_all_right(part)) continue;
    part.least = least_unexplained(part, most);
    if (part.least < most) open.push_back(part);
  }
  std::sort(open.begin() + first, open.end(), [](const Box& a, const Box& b) { return a.least > b.least; });
}

PathSearch::Rival PathSearch::best_rival(double most, double enough) {
  Rival best{path_.map_from_middle, most};
  std::vector<Box> open = first_boxes(most);
  std::sort(open.begin(), open.end(), [](const Box& a, const Box& b) { return a.least > b.least; });
  while (!open.empty() && best.unexplained > enough) {
    const Box box = open.back();
    open.pop_back();
    if (box.least >= best.unexplained || is_all_right(box)) continue;
    if (2.0 * box.half_m > kLast_m) {
      split(box, best.unexplained, open);
      continue;
    }
    if (!is_wrong(box.middle) || unexplained(box.middle) > best.unexplained + kWorthClimbing * path_.pieces) continue;
    if (const Rival found = climbed(box.middle); found.unexplained < best.unexplained) best = found;
  }
  return best;
}

}  // namespace deltamap::experiments
