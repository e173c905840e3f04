// SPDX-License-Identifier: Apache-2.0
#include "simulation/robot/route_pilot.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>
#include <numbers>
#include <queue>

namespace deltamap::simulation {
namespace {

constexpr double kNarrowCost = 6.0;      // of a metre with clearance only, against one with comfort
constexpr double kAvoided_m = 0.8;       // floor around a person in the way, to the robot's centre
constexpr double kAvoidedRoom_m = 0.45;  // the same beside something larger than a person
constexpr double kLeafRoom_m = 0.3;      // of the robot's middle from a door's leaf: its body passes
constexpr double kCarrot_m = 2.0;        // how far ahead of itself it looks along the way
constexpr double kArrived_m = 0.5;       // from the goal
constexpr double kStrayed_m = 1.5;       // from the way: it was carried off
constexpr double kBacking_m_per_s = 0.15;
constexpr double kBacking_s = 2.0;
constexpr double kAheadCosine = 0.5;  // within 60° of its nose
constexpr double kTurnOnSpot_rad = 0.7;
constexpr double kTurnGain_per_s = 2.0;
constexpr int kTries = 20;  // goals drawn until one can be reached

struct Step {
  int column, row;
  double length;  // cells
};
constexpr std::array<Step, 8> kSteps{{{1, 0, 1.0},
                                      {0, 1, 1.0},
                                      {-1, 0, 1.0},
                                      {0, -1, 1.0},
                                      {1, 1, std::numbers::sqrt2},
                                      {-1, 1, std::numbers::sqrt2},
                                      {-1, -1, std::numbers::sqrt2},
                                      {1, -1, std::numbers::sqrt2}}};

std::vector<Cell> cells_of(const ReachableFloor& floor) {
  std::vector<Cell> cells;
  for (std::size_t i = 0; i < floor.reached.size(); ++i) {
    if (floor.reached[i]) cells.push_back(floor.geometry.cell_of(i));
  }
  return cells;
}

/// The reached cell nearest to a point.
std::optional<Cell> nearest_reached(const ReachableFloor& floor, const Point2& point) {
  const Cell own = floor.geometry.cell_at(point);
  std::optional<Cell> nearest;
  int least = std::numeric_limits<int>::max();
  constexpr int kReach = 8;
  for (int row = -kReach; row <= kReach; ++row) {
    for (int column = -kReach; column <= kReach; ++column) {
      const Cell cell{own.column + column, own.row + row};
      const int distance2 = row * row + column * column;
      if (distance2 >= least || !floor.geometry.contains(cell)) continue;
      if (!floor.reached[floor.geometry.index_of(cell)]) continue;
      least = distance2;
      nearest = cell;
    }
  }
  return nearest;
}

/// The cheapest way between two cells (Dijkstra), both included; empty where there is none.
class WaySearch {
 public:
  WaySearch(const ReachableFloor& floor, const ReachableFloor& roomy, std::span<const Circle> avoided)
      : floor_{floor}, roomy_{roomy}, avoided_{avoided} {}

  [[nodiscard]] std::vector<Point2> way(Cell from, Cell to) const {
    const GridGeometry& geometry = floor_.geometry;
    std::vector<float> cost(geometry.cell_count(), std::numeric_limits<float>::infinity());
    std::vector<std::uint32_t> towards(geometry.cell_count(), 0);
    using Open = std::pair<float, std::uint32_t>;
    std::priority_queue<Open, std::vector<Open>, std::greater<>> open;
    const auto start =
        static_cast<std::uint32_t>(geometry.index_of(to));  // searched backwards, so that it reads forwards
    const auto end = static_cast<std::uint32_t>(geometry.index_of(from));
    cost[start] = 0.0F;
    open.emplace(0.0F, start);
    while (!open.empty() && open.top().second != end) {
      const auto [paid, index] = open.top();
      open.pop();
      if (paid > cost[index]) continue;
      const Cell cell = geometry.cell_of(index);
      for (const Step& step : kSteps) {
        const Cell next{cell.column + step.column, cell.row + step.row};
        if (!is_passable(next)) continue;
        const auto next_index = static_cast<std::uint32_t>(geometry.index_of(next));
        const double price = step.length * (roomy_.reached[next_index] ? 1.0 : kNarrowCost);
        const float total = paid + static_cast<float>(price);
        if (total >= cost[next_index]) continue;
        cost[next_index] = total;
        towards[next_index] = index;
        open.emplace(total, next_index);
      }
    }
    if (!std::isfinite(cost[end])) return {};
    std::vector<Point2> points{geometry.centre_of(from)};
    for (std::uint32_t index = end; index != start; index = towards[index]) {
      points.push_back(geometry.centre_of(geometry.cell_of(towards[index])));
    }
    return points;
  }

 private:
  [[nodiscard]] bool is_passable(Cell cell) const {
    if (!floor_.geometry.contains(cell) || !floor_.reached[floor_.geometry.index_of(cell)]) return false;
    const Point2 centre = floor_.geometry.centre_of(cell);
    return std::none_of(avoided_.begin(), avoided_.end(), [&](const Circle& body) {
      return (body.centre - centre).norm() < std::max(kAvoided_m, body.radius_m + kAvoidedRoom_m);
    });
  }

  const ReachableFloor& floor_;
  const ReachableFloor& roomy_;
  std::span<const Circle> avoided_;
};

}  // namespace

RoutePilot::RoutePilot(const RoutePilotParams& params, const World& world, const Point2& from, Random random)
    : params_{params}, random_{random} {
  see(world, from);
}

void RoutePilot::see(const World& world, const Point2& from) {
  floor_ = reachable_floor(world, from, params_.clearance_m);
  roomy_ = reachable_floor(world, from, params_.comfort_m);
  places_ = cells_of(roomy_);
  if (places_.empty()) places_ = cells_of(floor_);
  forget_way();
}

devices::DriveTarget RoutePilot::target(const RobotState& robot, const Bodies& bodies, double dt_s) {
  const Pose2& at = robot.map_from_robot;
  if (backing_left_s_ > 0.0) {
    backing_left_s_ -= dt_s;
    if (!robot.stalled) return {.speed_m_per_s = -kBacking_m_per_s};
    backing_left_s_ = 0.0;
  }
  const bool held_up = someone_ahead(at, bodies.walkers()) || leaf_ahead(at, bodies.leaves());
  waited_s_ = held_up || robot.stalled ? waited_s_ + dt_s : 0.0;
  if (robot.stalled && waited_s_ > 1.0) {
    waited_s_ = 0.0;
    backing_left_s_ = kBacking_s;
    forget_way();
    return {};
  }
  if (waited_s_ > params_.patience_s) {
    waited_s_ = 0.0;
    plan(at.position(), bodies.obstacles());
    // Off the person's direction first: a turn on the spot brings it out of sight.
  }
  const bool arrived = way_.empty() || (way_.back() - at.position()).norm() < kArrived_m;
  if (arrived || (way_[std::min(next_, way_.size() - 1)] - at.position()).norm() > kStrayed_m) {
    plan(at.position());
  }
  if (way_.empty()) return {.turn_rate_rad_per_s = 0.5 * params_.turn_rate_rad_per_s};
  devices::DriveTarget wanted = towards(carrot(at.position()), at);
  if (held_up) wanted.speed_m_per_s = 0.0;
  return wanted;
}

bool RoutePilot::someone_ahead(const Pose2& map_from_robot, std::span<const Circle> people) const {
  const Point2 nose{std::cos(map_from_robot.theta), std::sin(map_from_robot.theta)};
  return std::any_of(people.begin(), people.end(), [&](const Circle& person) {
    const Point2 to_person = person.centre - map_from_robot.position();
    const double distance_m = to_person.norm();
    return distance_m - person.radius_m < params_.sight_m && to_person.dot(nose) > kAheadCosine * distance_m;
  });
}

/// Whether a door's leaf crosses the next metre of the way.
bool RoutePilot::leaf_ahead(const Pose2& map_from_robot, std::span<const Segment> leaves) const {
  return std::any_of(leaves.begin(), leaves.end(), [&](const Segment& leaf) {
    const Point2 begin = map_from_robot * Point2{kLeafRoom_m, 0.0};
    const Point2 end = map_from_robot * Point2{params_.sight_m, 0.0};
    return distance_between(Segment{begin, end}, leaf) < kLeafRoom_m;
  });
}

bool RoutePilot::is_open(const Point2& from, const Point2& to, const ReachableFloor& floor) const {
  const double length_m = (to - from).norm();
  const int pieces = 1 + static_cast<int>(length_m / (0.5 * floor.geometry.resolution_m));
  for (int i = 1; i <= pieces; ++i) {
    if (!floor.contains(from + (static_cast<double>(i) / pieces) * (to - from))) return false;
  }
  return true;
}

/// The farthest point of the way near ahead that can be driven to in a straight line.
Point2 RoutePilot::carrot(const Point2& from) {
  const auto distance = [&](std::size_t i) { return (way_[i] - from).norm(); };
  while (next_ + 1 < way_.size() && distance(next_ + 1) <= distance(next_)) ++next_;
  std::size_t chosen = std::min(next_ + 2, way_.size() - 1);
  const ReachableFloor& floor = roomy_.contains(from) ? roomy_ : floor_;
  for (std::size_t i = chosen; i < way_.size() && distance(i) < kCarrot_m; ++i) {
    if (is_open(from, way_[i], floor)) chosen = i;
  }
  return way_[chosen];
}

devices::DriveTarget RoutePilot::towards(const Point2& place, const Pose2& map_from_robot) const {
  const Point2 way = place - map_from_robot.position();
  const double off_rad = turn_between(map_from_robot.theta, std::atan2(way.y(), way.x()));
  devices::DriveTarget wanted;
  wanted.turn_rate_rad_per_s =
      std::clamp(kTurnGain_per_s * off_rad, -params_.turn_rate_rad_per_s, params_.turn_rate_rad_per_s);
  wanted.speed_m_per_s = params_.speed_m_per_s * std::max(0.0, 1.0 - std::abs(off_rad) / kTurnOnSpot_rad);
  return wanted;
}

void RoutePilot::plan(const Point2& from, std::span<const Circle> avoided) {
  forget_way();
  next_ = 0;
  const auto start = nearest_reached(floor_, from);
  if (!start || places_.empty()) return;
  const WaySearch search{floor_, roomy_, avoided};
  for (int attempt = 0; attempt < kTries && way_.empty(); ++attempt) {
    const auto goal = params_.round.empty() ? drawn_goal(from, attempt + 1 == kTries) : goal_of_round(from);
    if (goal) way_ = search.way(*start, *goal);
    if (way_.empty()) ++place_;  // cannot be reached now
  }
}

std::optional<Cell> RoutePilot::drawn_goal(const Point2& from, bool however_near) {
  const Cell goal = places_[random_.index_below(static_cast<std::uint32_t>(places_.size()))];
  const double way_m = (floor_.geometry.centre_of(goal) - from).norm();
  if (way_m < params_.least_way_m && !however_near) return std::nullopt;
  return goal;
}

/// The next place of the round, or the floor nearest to it.
std::optional<Cell> RoutePilot::goal_of_round(const Point2& from) {
  const auto goal = [&] { return nearest_reached(floor_, params_.round[place_ % params_.round.size()]); };
  const auto present = goal();
  if (!present || (floor_.geometry.centre_of(*present) - from).norm() > kArrived_m) return present;
  ++place_;
  return goal();
}

Pose2 RoutePilot::place_anywhere(Random& random) const {
  assert(!places_.empty() && "there is floor to stand on");
  const Cell cell = places_[random.index_below(static_cast<std::uint32_t>(places_.size()))];
  const double side_m = floor_.geometry.resolution_m;
  const Point2 offset{random.uniform(-0.5, 0.5) * side_m, random.uniform(-0.5, 0.5) * side_m};
  const Point2 place = floor_.geometry.centre_of(cell) + offset;
  return {place.x(), place.y(), random.uniform(-std::numbers::pi, std::numbers::pi)};
}

}  // namespace deltamap::simulation
