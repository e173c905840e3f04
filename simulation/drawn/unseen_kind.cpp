// SPDX-License-Identifier: Apache-2.0
#include "simulation/drawn/unseen_kind.hpp"

#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>

#include "core/geometry/angle.hpp"
#include "simulation/drawn/layout_builder.hpp"
#include "simulation/world/chance.hpp"

namespace deltamap::simulation::drawn {
namespace {

constexpr double kFastest_hz = 75.0;  // of the mirror
constexpr double kSlowest_hz = 1.0;
constexpr std::array<drivers::lms200::ScanVariant, 5> kFans{{{180, 100}, {180, 50}, {100, 100}, {100, 50}, {100, 25}}};
constexpr std::array kRanges_m{8.0, 32.0, 80.0};

/// Each group has its own chance, so that another number in one leaves the others as they were.
enum class KindChance : std::uint64_t { kMap, kLaser, kRobot, kLife, kLayout };

template <typename Items>
auto one_of(const Items& items, Random& random) {
  return items[random.index_below(static_cast<std::uint32_t>(items.size()))];
}

bool with_chance(double share, Random& random) { return random.uniform() < share; }

/// Seven seeds in a row have seven layouts, in an order of their own.
LayoutKind layout_of(std::uint64_t seed) {
  std::array<std::uint32_t, kLayoutKinds> order{};
  std::iota(order.begin(), order.end(), 0U);
  Random random = random_for(seed / kLayoutKinds, KindChance::kLayout);
  for (std::uint32_t left = kLayoutKinds; left > 1; --left) std::swap(order[left - 1], order[random.index_below(left)]);
  return static_cast<LayoutKind>(order[static_cast<std::size_t>(seed % kLayoutKinds)]);
}

void draw_map(UnseenKind& kind, Random random) {
  kind.resolution_m = with_chance(0.5, random) ? 0.05 : 0.1;
  kind.from_first_drive = with_chance(0.4, random);
  const double outdated_share = random.uniform(0.0, 0.5);
  if (with_chance(0.4, random)) kind.outdated_share = outdated_share;
}

void draw_laser(UnseenKind& kind, Random random) {
  kind.fan = one_of(kFans, random);
  kind.range_m = one_of(kRanges_m, random);
  // Log-uniform: the highest rates, which take the longest to compute, are drawn seldom.
  const double turns = kind.fan.turns();
  const double period_turns = turns * std::round(log_uniform(1.0, kFastest_hz / kSlowest_hz / turns, random));
  kind.scan_period_s = period_turns * drivers::lms200::kMirrorTurnS;
  kind.range_noise_m = random.uniform(0.005, 0.02);
  const double off_m = random.uniform(0.0, 0.02);
  const double towards_rad = random.uniform(-std::numbers::pi, std::numbers::pi);
  kind.told_from_true_mount = {off_m * std::cos(towards_rad), off_m * std::sin(towards_rad),
                               radians(random.uniform(-0.5, 0.5))};
}

void draw_robot(UnseenKind& kind, Random random) {
  kind.speed_m_per_s = random.uniform(0.2, 1.2);
  kind.wheels = {random.uniform(-0.02, 0.02), random.uniform(-0.02, 0.02), radians(random.uniform(-0.3, 0.3))};
  kind.wheel_noise_m_per_sqrt_m = log_uniform(0.001, 0.008, random);
  kind.odometry_lag_s = random.uniform(0.0, 0.15);
  const SlipParams slips{.every_m = log_uniform(20.0, 150.0, random),
                         .length_m = random.uniform(0.05, 0.3),
                         .turn_rad = random.uniform(0.02, 0.15),
                         .lasts_s = random.uniform(0.2, 1.0)};
  if (with_chance(0.5, random)) kind.slips = slips;
  kind.knows_start = with_chance(0.7, random);
}

void draw_life(UnseenKind& kind, Random random) {
  kind.people.all = static_cast<int>(random.index_below(11));
  kind.people.stopping = static_cast<int>(random.index_below(static_cast<std::uint32_t>(kind.people.all / 2 + 1)));
  kind.changes_per_min = log_uniform(0.2, 4.0, random);
  kind.turns_rad = with_chance(0.5, random) ? radians(random.uniform(0.0, 15.0)) : 0.0;
  const CreepParams creep{.containers = 1 + static_cast<int>(random.index_below(4)),
                          .step_m = random.uniform(0.02, 0.08),
                          .every_s = random.uniform(40.0, 120.0)};
  if (with_chance(0.4, random)) kind.creep = creep;
  const GapParams gaps{.every_s = log_uniform(150.0, 900.0, random)};
  if (with_chance(0.7, random)) kind.gaps = gaps;
}

}  // namespace

UnseenKind unseen_kind(std::uint64_t seed) {
  UnseenKind kind;
  kind.layout = layout_of(seed);
  draw_map(kind, random_for(seed, KindChance::kMap));
  draw_laser(kind, random_for(seed, KindChance::kLaser));
  draw_robot(kind, random_for(seed, KindChance::kRobot));
  draw_life(kind, random_for(seed, KindChance::kLife));
  return kind;
}

}  // namespace deltamap::simulation::drawn
