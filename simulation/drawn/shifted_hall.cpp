// SPDX-License-Identifier: Apache-2.0
#include "simulation/drawn/shifted_hall.hpp"

#include <numbers>

#include "simulation/world/chance.hpp"
#include "simulation/world/standing_room.hpp"

namespace deltamap::simulation::drawn {
namespace {

constexpr int kBlocks = 4;  // in a row, and rows
constexpr double kContainer_m = 5.0;
constexpr double kGap_m = 0.9;    // between the containers of a block, so that one can be pushed either way
constexpr double kAisle_m = 3.6;  // more than two that are pushed towards each other, and a passage
constexpr double kBlock_m = 2.0 * kContainer_m + kGap_m;
constexpr double kPitch_m = kBlock_m + kAisle_m;
constexpr double kSide_m = kBlocks * kPitch_m + kAisle_m;
constexpr WheelErrors kWheels{0.01, 0.02, radians(0.17)};
constexpr int kWalkers = 3;
constexpr int kCrowd = 12;
constexpr std::size_t kClutterBoxes = 60;
constexpr double kBeside_m = 0.2;  // clutter stands no farther from a container or a wall

enum class HallChance : std::uint64_t { kPlace, kPeople, kClutter };

/// Along the middle of aisle 0 to kBlocks.
double aisle_m(std::uint32_t aisle) { return 0.5 * kAisle_m + aisle * kPitch_m; }

Point2 crossing(Random& random) {
  const double x_m = aisle_m(random.index_below(kBlocks + 1));
  return {x_m, aisle_m(random.index_below(kBlocks + 1))};
}

/// On round coordinates, as a survey would lay its lattice: surfaces are in the middle of M_0's cells.
void build(Scenario& scenario) {
  int id = 1;
  scenario.world.objects.push_back(
      {id, ObjectKind::kWall, Polyline{{{0.0, 0.0}, {kSide_m, 0.0}, {kSide_m, kSide_m}, {0.0, kSide_m}, {0.0, 0.0}}}});
  for (int i = 0; i < 4 * kBlocks * kBlocks; ++i) {
    const int column = i % (2 * kBlocks);
    const int row = i / (2 * kBlocks);
    const auto middle_m = [](int number) {
      return kAisle_m + (number / 2) * kPitch_m + (number % 2) * (kContainer_m + kGap_m) + 0.5 * kContainer_m;
    };
    const Box box{{middle_m(column), middle_m(row)}, kContainer_m, kContainer_m, 0.0};
    scenario.world.objects.push_back({++id, ObjectKind::kContainer, box});
    scenario.slots.push_back(box);
  }
}

/// Round a rectangle of aisles, or up and down one.
PersonParams walker(Random& random) {
  PersonParams person;
  const Point2 from = crossing(random);
  Point2 to = crossing(random);
  while (to == from) to = crossing(random);
  if (from.x() == to.x() || from.y() == to.y()) {
    person.path = {from, to};
  } else {
    person.path = {from, {to.x(), from.y()}, to, {from.x(), to.y()}};
    person.closed = true;
  }
  // Not in the very middle, where the robot drives.
  const Point2 aside{random.uniform(-0.8, 0.8), random.uniform(-0.8, 0.8)};
  for (Point2& point : person.path) point += aside;
  person.speed_m_per_s = random.uniform(0.7, 1.5);
  return person;
}

/// Boxes beside the containers, where M_0 has nothing.
std::vector<Change> clutter(const Scenario& scenario, Random random) {
  std::vector<Change> changes;
  World world = scenario.world;
  for (int id = world.largest_id() + 1; changes.size() < kClutterBoxes;) {
    const Point2 place{random.uniform(0.0, kSide_m), random.uniform(0.0, kSide_m)};
    const Box box{place, random.uniform(0.3, 0.8), random.uniform(0.3, 0.8), random.uniform(0.0, std::numbers::pi)};
    const Circle start{scenario.robot.map_from_start.position(), scenario.robot.body.radius_m};
    if (!stands_free(box, 0, world) || stands_free(grown(box, kBeside_m), 0, world) || !keeps_away(box, start, 1.0))
      continue;
    changes.push_back({ChangeKind::kAdded, id++, box, std::nullopt});
    world = changed(world, changes.back());
  }
  return changes;
}

}  // namespace

Drawn shifted_hall(const ShiftedHallParams& params, std::uint64_t seed) {
  Drawn drawn;
  Scenario& scenario = drawn.scenario;
  Random place = random_for(seed, HallChance::kPlace);
  build(scenario);
  const Point2 start = crossing(place);
  scenario.robot.map_from_start = {start.x(), start.y(), place.uniform(-std::numbers::pi, std::numbers::pi)};
  scenario.robot.body = with_wheel_errors(scenario.robot.body, kWheels);
  scenario.robot.body.wheel_noise_m_per_sqrt_m *= params.wheel_noise_times;
  scenario.laser.optics.range_noise_m = 0.01;
  Random people = random_for(seed, HallChance::kPeople);
  for (int i = 0; i < (params.crowd ? kCrowd : kWalkers); ++i) scenario.people.push_back(walker(people));

  VirtualDriveParams& drive = drawn.drive;
  drive.seed = seed;
  drive.scan_period_s = 0.2;
  drive.max_range_m = params.range_m;
  drive.forklift = ForkliftParams{.kinds = {ChangeKind::kShifted},
                                  .largest_shift_m = 0.8,
                                  .shifts_anywhere = true,
                                  .largest_turn_rad = params.largest_turn_rad,
                                  .lanes_kept = 0.6};
  if (params.slips) drive.slips = SlipParams{};
  if (params.crowd) drive.changes_at_start = clutter(scenario, random_for(seed, HallChance::kClutter));
  return drawn;
}

}  // namespace deltamap::simulation::drawn
