// SPDX-License-Identifier: Apache-2.0
// Puts a layout together: walls, posts, and things that find themselves a place with a way round them.
#pragma once

#include <optional>
#include <vector>

#include "core/random.hpp"
#include "simulation/drawn/layout.hpp"

namespace deltamap::simulation::drawn {

/// Sizes of things, log-uniform, and the way that stays free around them.
struct ScatterParams {
  double least_m = 0.4;  ///< > 0
  double most_m = 6.0;   ///< >= least_m
  double way_m = 1.5;    ///< between one thing and all others but its neighbour, > 0
  bool any_angle = false;
};

class LayoutBuilder {
 public:
  explicit LayoutBuilder(Random& random) : random_{random} {}

  void wall(std::vector<Point2> points);
  /// Closed.
  void walls_round(std::vector<Point2> corners);
  void post(const Box& box) { add(ObjectKind::kPost, box); }
  /// A place for a thing, which is empty now and then.
  void slot(const Box& box);
  /// Things anywhere inside of the outline; fewer than `count` where there is no room.
  void scatter(int count, const std::vector<Point2>& outline, const ScatterParams& params);
  /// A thing with its back to a wall, if nothing stands there and before it, and nothing but walls is nearer than
  /// way_m. `inside`: the side of the wall.
  void lean(const Segment& wall, const Point2& inside, const ScatterParams& params, double depth_m);
  [[nodiscard]] Layout finished(double passage_m, const Pose2& map_from_layout);

 private:
  void add(ObjectKind kind, Shape shape);
  [[nodiscard]] std::optional<Box> thing_anywhere(const std::vector<Point2>& outline, const ScatterParams& params);
  [[nodiscard]] std::optional<Box> thing_beside_another(const ScatterParams& params);
  [[nodiscard]] double size_m(double least_m, double most_m);

  Random& random_;
  Layout layout_;
};

[[nodiscard]] bool is_within(const Point2& point, const std::vector<Point2>& outline);
[[nodiscard]] std::vector<Point2> rectangle(const Point2& low, const Point2& high);
[[nodiscard]] double log_uniform(double least, double most, Random& random);

}  // namespace deltamap::simulation::drawn
