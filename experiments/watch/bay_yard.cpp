// SPDX-License-Identifier: Apache-2.0
#include "experiments/watch/bay_yard.hpp"

#include <algorithm>
#include <cmath>

#include "core/geometry/angle.hpp"

namespace deltamap::experiments {

using mapping::bays::Bay;
using mapping::bays::BayState;
using simulation::Box;

namespace {

constexpr double kBaySide_m = 2.4;
constexpr int kBaysInRow = 8;
constexpr double kRowBegins_m = 4.0;
constexpr double kRows_m[] = {4.0, 6.4, 14.0};  // lower sides: two stand back to back
const Point2 kYardSize_m{30.0, 20.0};
constexpr int kYardBeams = 181;
constexpr double kYardRange_m = 30.0;
constexpr double kYardNoise_m = 0.015;
constexpr double kInViewWithin_m = 10.0;
constexpr int kBeamsInView = 12;

simulation::Object object_of(int id, simulation::ObjectKind kind, simulation::Shape shape) {
  simulation::Object object;
  object.id = id;
  object.kind = kind;
  object.shape = std::move(shape);
  return object;
}

/// Distance at which a line enters a convex polygon; nothing where it passes it by.
std::optional<double> entry_m(const Polygon& polygon, const Point2& from, const Point2& direction) {
  std::optional<double> nearest;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Point2& a = polygon[i];
    const Point2 side = polygon[(i + 1) % polygon.size()] - a;
    const double across = direction.x() * side.y() - direction.y() * side.x();
    if (std::abs(across) < 1e-9) continue;
    const Point2 to_a = a - from;
    const double along = (to_a.x() * side.y() - to_a.y() * side.x()) / across;
    const double share = (to_a.x() * direction.y() - to_a.y() * direction.x()) / across;
    if (along >= 0.0 && share >= 0.0 && share <= 1.0 && (!nearest || along < *nearest)) nearest = along;
  }
  return nearest;
}

}  // namespace

BayYard::BayYard(std::uint64_t seed) : random_{seed} {
  const Point2& high = kYardSize_m;
  int id = 0;
  walls_.objects.push_back(object_of(
      ++id, simulation::ObjectKind::kWall,
      simulation::Polyline{{{0.0, 0.0}, {high.x(), 0.0}, {high.x(), high.y()}, {0.0, high.y()}, {0.0, 0.0}}}));
  for (int post = 0; post < 12; ++post) {  // along the walls, so that no two places look alike
    const double along = random_.uniform(2.0, high.x() - 2.0);
    const Point2 at{along, post % 2 == 0 ? 0.3 : high.y() - 0.3};
    walls_.objects.push_back(
        object_of(++id, simulation::ObjectKind::kPost, Box{at, random_.uniform(0.3, 0.9), 0.6, 0.0}));
  }
  for (const double row_m : kRows_m) {
    for (int i = 0; i < kBaysInRow; ++i) {
      const Point2 low{kRowBegins_m + i * kBaySide_m, row_m};
      Bay bay{.id = std::to_string(bays_.size() + 1), .polygon = {}};
      for (const Point2& corner :
           {Point2{0.0, 0.0}, Point2{kBaySide_m, 0.0}, Point2{kBaySide_m, kBaySide_m}, Point2{0.0, kBaySide_m}})
        bay.polygon.push_back(low + corner);
      bays_.push_back(std::move(bay));
    }
  }
  truths_.resize(bays_.size(), BayState::kUnknown);
  loads_.resize(bays_.size());
  for (std::size_t i = 0; i < bays_.size(); ++i) change(i);
}

void BayYard::change(std::size_t bay) {
  const BayState before = truths_[bay];
  while (truths_[bay] == before) {
    const double dice = random_.uniform();
    truths_[bay] = dice < 0.4 ? BayState::kEmpty : dice < 0.6 ? BayState::kPartly : BayState::kFull;
  }
  const Point2 middle = 0.5 * (bays_[bay].polygon[0] + bays_[bay].polygon[2]);
  loads_[bay].reset();
  if (truths_[bay] == BayState::kFull) {
    const Point2 off{random_.uniform(-0.08, 0.08), random_.uniform(-0.08, 0.08)};
    loads_[bay] = Box{middle + off, random_.uniform(2.2, 2.4), random_.uniform(2.2, 2.4), random_.uniform(-0.03, 0.03)};
  } else if (truths_[bay] == BayState::kPartly) {
    const Point2 off{random_.uniform(-0.5, 0.5), random_.uniform(-0.6, 0.6)};
    loads_[bay] = Box{middle + off, 1.2, random_.uniform(0.8, 1.0), random_.uniform(-0.1, 0.1)};
  }
  rebuild();
}

void BayYard::rebuild() {
  world_ = walls_;
  for (std::size_t i = 0; i < loads_.size(); ++i) {
    if (loads_[i])
      world_.objects.push_back(object_of(100 + static_cast<int>(i), simulation::ObjectKind::kContainer, *loads_[i]));
  }
  caster_.emplace(world_);
}

std::vector<Point2> BayYard::way() { return {{2.0, 2.0}, {27.0, 2.0}, {27.0, 11.4}, {2.0, 11.4}}; }

Point2 BayYard::floor(Random& random) const {
  const double dice = random.uniform();
  if (dice < 0.3) return {random.uniform(1.5, 28.0), random.uniform(1.5, 3.2)};
  if (dice < 0.6) return {random.uniform(1.5, 28.0), random.uniform(9.6, 13.2)};
  for (;;) {
    const std::size_t bay = random.index_below(static_cast<std::uint32_t>(bays_.size()));
    Point2 at = bays_[bay].polygon[0] + Point2{random.uniform(0.4, 2.0), random.uniform(0.4, 2.0)};
    if (truths_[bay] != BayState::kFull && (!loads_[bay] || simulation::distance_between(at, *loads_[bay]) > 0.4))
      return at;
  }
}

std::vector<double> BayYard::ranges(const Pose2& map_from_robot, const simulation::MovingSurfaces& moving) const {
  std::vector<double> ranges;
  for (int i = 0; i < kYardBeams; ++i) {
    const auto hit =
        caster_->cast(map_from_robot.position(), map_from_robot.theta + radians(i - 90.0), kYardRange_m, moving);
    ranges.push_back(hit ? hit->range_m : -1.0);
  }
  return ranges;
}

BayYard::Beams BayYard::beams_to(std::size_t bay, const Pose2& map_from_robot,
                                 const std::vector<double>& ranges) const {
  constexpr double kRimOfView_m = 0.25;
  Beams beams;
  for (int i = 0; i < kYardBeams; ++i) {
    const double direction = map_from_robot.theta + radians(i - 90.0);
    const auto enters =
        entry_m(bays_[bay].polygon, map_from_robot.position(), {std::cos(direction), std::sin(direction)});
    if (!enters) continue;
    ++beams.aimed;
    const double range_m = ranges[static_cast<std::size_t>(i)];
    if (range_m < 0.0 || range_m >= *enters - kRimOfView_m) ++beams.reached;
  }
  return beams;
}

bool BayYard::is_reached(std::size_t bay, const Pose2& map_from_robot, const std::vector<double>& ranges) const {
  return beams_to(bay, map_from_robot, ranges).reached > 0;
}

double BayYard::view_of(std::size_t bay, const Pose2& map_from_robot, const std::vector<double>& ranges) const {
  const Polygon& polygon = bays_[bay].polygon;
  if ((0.5 * (polygon[0] + polygon[2]) - map_from_robot.position()).norm() > kInViewWithin_m) return 0.0;
  const Beams beams = beams_to(bay, map_from_robot, ranges);
  return beams.aimed < kBeamsInView ? 0.0 : static_cast<double>(beams.reached) / beams.aimed;
}

Scan scan_of(const std::vector<double>& ranges, Timestamp time, Random& random) {
  Scan scan;
  scan.time = scan.received = time;
  scan.first_bearing_rad = radians(-90.0);
  scan.bearing_step_rad = radians(1.0);
  scan.max_range_m = kYardRange_m;
  for (const double range_m : ranges) {
    Beam beam{.range_m = 0.0F, .offset_s = 0.0F, .kind = BeamKind::kBeyondMaximum};
    if (range_m >= 0.0) {
      beam.kind = BeamKind::kRange;
      beam.range_m = static_cast<float>(std::max(0.05, range_m + random.normal(kYardNoise_m)));
    }
    scan.beams.push_back(beam);
  }
  return scan;
}

}  // namespace deltamap::experiments
