// SPDX-License-Identifier: Apache-2.0
#include "simulation/drawn/unseen_world.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "simulation/changes/changed_hall.hpp"
#include "simulation/drawn/first_drive.hpp"
#include "simulation/drawn/layout_builder.hpp"
#include "simulation/scenario/start_map.hpp"
#include "simulation/world/chance.hpp"
#include "simulation/world/passages.hpp"

namespace deltamap::simulation::drawn {
namespace {

constexpr double kClearance_m = 0.4;     // of the robot's middle
constexpr double kSeenShare = 0.25;      // of the changes that may happen in view
constexpr double kLargestShift_m = 0.8;  // in x and in y
constexpr double kLanesKept = 0.85;      // of the floor
constexpr int kStarts = 400;             // places that are tried for the largest floor; corridors are a small part
constexpr int kPathTries = 200;

enum class WorldChance : std::uint64_t { kLayout, kStart, kPeople, kOutdated, kFirstDrive };

Point2 anywhere_in(const Bounds& bounds, Random& random) {
  const double x = random.uniform(bounds.low.x(), bounds.high.x());
  return {x, random.uniform(bounds.low.y(), bounds.high.y())};
}

/// The largest floor inside of the outer wall that is in one piece.
ReachableFloor main_floor(const World& world, double clearance_m, Random& random) {
  const auto& outline = std::get<Polyline>(world.objects.front().shape).points;
  const Bounds bounds = bounds_of(world);
  ReachableFloor largest;
  std::ptrdiff_t most = 0;
  for (int i = 0; i < kStarts; ++i) {
    const Point2 place = anywhere_in(bounds, random);
    const auto is_in = [&](const Object& object) { return distance_between(place, object.shape) < clearance_m; };
    if (!is_within(place, outline) || std::any_of(world.objects.begin(), world.objects.end(), is_in)) continue;
    if (!largest.reached.empty() && largest.contains(place)) continue;
    ReachableFloor floor = reachable_floor(world, place, clearance_m);
    const auto cells = std::count(floor.reached.begin(), floor.reached.end(), true);
    if (cells <= most) continue;
    most = cells;
    largest = std::move(floor);
  }
  if (most == 0) throw std::runtime_error("a drawn world has no floor");
  return largest;
}

class FloorPlaces {
 public:
  explicit FloorPlaces(const ReachableFloor& floor) : geometry_{floor.geometry} {
    for (std::size_t i = 0; i < floor.reached.size(); ++i) {
      if (floor.reached[i]) cells_.push_back(i);
    }
  }
  [[nodiscard]] Point2 any(Random& random) const {
    const std::size_t cell = cells_[random.index_below(static_cast<std::uint32_t>(cells_.size()))];
    return geometry_.centre_of(geometry_.cell_of(cell));
  }

 private:
  GridGeometry geometry_;
  std::vector<std::size_t> cells_;
};

/// A straight way of some metres between two places of the floor, up and down.
std::vector<Point2> straight_way(const FloorPlaces& places, const RayCaster& surfaces, Random& random) {
  for (int attempt = 0; attempt < kPathTries; ++attempt) {
    const Point2 from = places.any(random);
    const Point2 way = places.any(random) - from;
    const double length_m = way.norm();
    if (length_m < 3.0) continue;
    if (!surfaces.cast(from, std::atan2(way.y(), way.x()), length_m + 0.3)) return {from, from + way};
  }
  return {};
}

void add_people(const People& people, const FloorPlaces& places, Scenario& scenario, Random random) {
  const RayCaster surfaces{scenario.world};
  for (int i = 0; i < people.all; ++i) {
    std::vector<Point2> path = straight_way(places, surfaces, random);
    if (path.empty()) continue;
    const double speed_m_per_s = random.uniform(0.5, 1.6);
    const double radius_m = random.uniform(0.06, 0.25);  // a leg, or a body
    if (i < people.stopping) {
      scenario.actors.push_back({.path = path, .speed_m_per_s = speed_m_per_s, .radius_m = radius_m});
    } else {
      scenario.people.push_back({.path = path, .speed_m_per_s = speed_m_per_s, .radius_m = radius_m});
    }
  }
}

ForkliftParams forklift_of(const UnseenKind& kind, double passage_m) {
  ForkliftParams forklift;
  forklift.change_every_s = 60.0 / kind.changes_per_min;
  forklift.kinds = {ChangeKind::kRemoved, ChangeKind::kAdded, ChangeKind::kShifted, ChangeKind::kShifted};
  forklift.largest_shift_m = kLargestShift_m;
  forklift.shifts_anywhere = true;
  forklift.largest_turn_rad = kind.turns_rad;
  forklift.robot_margin_m = 0.6;
  forklift.passage_m = passage_m;
  forklift.lanes_kept = kLanesKept;
  forklift.least_filled = 0.5;
  return forklift;
}

VirtualDriveParams drive_of(const UnseenKind& kind, double passage_m, std::uint64_t seed) {
  VirtualDriveParams drive;
  drive.seed = seed;
  drive.fan = kind.fan;
  drive.scan_period_s = kind.scan_period_s;
  drive.max_range_m = kind.range_m;
  drive.odometry_lag_s = kind.odometry_lag_s;
  drive.route.speed_m_per_s = kind.speed_m_per_s;
  drive.route.clearance_m = kClearance_m;
  drive.route.comfort_m = 0.5 * passage_m;  // or it would stay on its side of a door
  drive.slips = kind.slips;
  drive.gaps = kind.gaps;
  drive.creep = kind.creep;
  drive.change_in_view_share = kSeenShare;
  return drive;
}

}  // namespace

UnseenWorld unseen_world(const UnseenKind& kind, std::uint64_t seed) {
  UnseenWorld unseen;
  Scenario& scenario = unseen.drawn.scenario;
  const Layout layout = drawn_layout(kind.layout, kind.range_m, random_for(seed, WorldChance::kLayout));
  scenario.world = layout.world;
  scenario.slots = layout.slots;
  Random start = random_for(seed, WorldChance::kStart);
  const FloorPlaces places{main_floor(layout.world, 0.5 * layout.passage_m, start)};
  const Point2 place = places.any(start);
  scenario.robot.map_from_start = {place.x(), place.y(), start.uniform(-std::numbers::pi, std::numbers::pi)};
  scenario.robot.body = with_wheel_errors(scenario.robot.body, kind.wheels);
  scenario.robot.body.wheel_noise_m_per_sqrt_m = kind.wheel_noise_m_per_sqrt_m;
  scenario.laser.optics.range_noise_m = kind.range_noise_m;
  add_people(kind.people, places, scenario, random_for(seed, WorldChance::kPeople));

  VirtualDriveParams& drive = unseen.drawn.drive;
  drive = drive_of(kind, layout.passage_m, seed);
  drive.told_mount = scenario.laser.optics.robot_from_laser * kind.told_from_true_mount;
  drive.forklift = forklift_of(kind, layout.passage_m);
  if (drive.creep) drive.creep->passage_m = layout.passage_m;
  if (kind.outdated_share > 0.0) {
    const Circle robot{place, scenario.robot.body.radius_m};
    drive.changes_at_start = changed_hall({.share = kind.outdated_share}, *drive.forklift, layout.slots, layout.world,
                                          layout.world, robot, {}, random_for(seed, WorldChance::kOutdated))
                                 .changes;
  }
  unseen.first_map = kind.from_first_drive ? map_of_first_drive(unseen.drawn, kind.resolution_m,
                                                                random_for(seed, WorldChance::kFirstDrive))
                                           : start_map(scenario, kind.resolution_m);
  return unseen;
}

}  // namespace deltamap::simulation::drawn
