// SPDX-License-Identifier: Apache-2.0
// Worlds that seeds draw: the same for the same seed, every number within its range, and fit to be driven in.
#include "simulation/drawn/unseen_world.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "core/geometry/angle.hpp"
#include "simulation/drawn/shifted_hall.hpp"
#include "simulation/world/standing_room.hpp"

namespace deltamap::simulation::drawn {
namespace {

constexpr std::uint64_t kSeeds = 200;
constexpr double kTiny = 1e-9;

bool same(const World& a, const World& b) {
  const auto equal = [](const Object& one, const Object& other) {
    const Bounds its = bounds_of({{one}});
    const Bounds others = bounds_of({{other}});
    return one.id == other.id && one.kind == other.kind && its.low == others.low && its.high == others.high;
  };
  return std::equal(a.objects.begin(), a.objects.end(), b.objects.begin(), b.objects.end(), equal);
}

bool same(const DriveStep& a, const DriveStep& b) {
  const auto equal = [](const Beam& one, const Beam& other) {
    return one.range_m == other.range_m && one.kind == other.kind;
  };
  return a.map_from_robot == b.map_from_robot && a.scan.time == b.scan.time && a.changes.size() == b.changes.size() &&
         std::equal(a.scan.beams.begin(), a.scan.beams.end(), b.scan.beams.begin(), b.scan.beams.end(), equal);
}

/// Of all seeds' values of one number: within [least, most], and not all in one half of it.
class Range {
 public:
  Range(double least, double most) : least_{least}, most_{most} {}
  void add(double value) {
    EXPECT_GE(value, least_ - kTiny);
    EXPECT_LE(value, most_ + kTiny);
    low_ += value < 0.5 * (least_ + most_) ? 1 : 0;
    ++all_;
  }
  void expect_used() const {
    EXPECT_GT(low_, 0);
    EXPECT_LT(low_, all_);
  }

 private:
  double least_;
  double most_;
  int low_ = 0;
  int all_ = 0;
};

TEST(UnseenKind, DrawsEveryNumberWithinItsRangeAndUsesTheRange) {
  Range outdated{0.0, 0.5}, rate_hz{0.9, 75.1}, noise_m{0.005, 0.02}, mount_m{0.0, 0.02}, mount_deg{-0.5, 0.5};
  Range scale{-0.02, 0.02}, turn{-0.02, 0.02}, drift_deg{-0.3, 0.3}, lag_s{0.0, 0.15}, speed{0.2, 1.2};
  Range people{0, 10}, changes{0.2, 4.0}, slip_m{0.05, 0.3}, gap_s{150.0, 900.0};
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const UnseenKind kind = unseen_kind(seed);
    outdated.add(kind.outdated_share);
    rate_hz.add(1.0 / kind.scan_period_s);
    noise_m.add(kind.range_noise_m);
    mount_m.add(kind.told_from_true_mount.position().norm());
    mount_deg.add(degrees(kind.told_from_true_mount.theta));
    scale.add(kind.wheels.scale);
    turn.add(kind.wheels.turn);
    drift_deg.add(degrees(kind.wheels.drift_rad_per_m));
    lag_s.add(kind.odometry_lag_s);
    speed.add(kind.speed_m_per_s);
    people.add(kind.people.all);
    changes.add(kind.changes_per_min);
    if (kind.slips) slip_m.add(kind.slips->length_m);
    if (kind.gaps) gap_s.add(kind.gaps->every_s);
    EXPECT_LE(kind.people.stopping, kind.people.all);
    EXPECT_TRUE(is_possible(kind.fan));
    EXPECT_GE(kind.scan_period_s, kind.fan.scan_duration_s() - kTiny) << "a scan takes its time";
  }
  for (const Range* range : {&outdated, &rate_hz, &noise_m, &mount_m, &mount_deg, &scale, &turn, &drift_deg, &lag_s,
                             &speed, &people, &changes, &slip_m, &gap_s}) {
    range->expect_used();
  }
}

TEST(UnseenKind, DrawsEveryChoice) {
  std::set<LayoutKind> layouts;
  std::set<unsigned> fans;
  std::set<double> ranges_m, resolutions_m;
  int known = 0, surveyed = 0, creeping = 0;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const UnseenKind kind = unseen_kind(seed);
    layouts.insert(kind.layout);
    fans.insert(kind.fan.values());
    ranges_m.insert(kind.range_m);
    resolutions_m.insert(kind.resolution_m);
    known += kind.knows_start ? 1 : 0;
    surveyed += kind.from_first_drive ? 1 : 0;
    creeping += kind.creep ? 1 : 0;
  }
  EXPECT_EQ(layouts.size(), kLayoutKinds);
  EXPECT_EQ(fans, (std::set<unsigned>{101, 181, 201, 361, 401}));
  EXPECT_EQ(ranges_m, (std::set<double>{8.0, 32.0, 80.0}));
  EXPECT_EQ(resolutions_m, (std::set<double>{0.05, 0.1}));
  for (const int count : {known, surveyed, creeping}) {
    EXPECT_GT(count, 0);
    EXPECT_LT(count, static_cast<int>(kSeeds));
  }
}

TEST(Layout, StandsApartAndHasThingsOfManySizes) {
  double least_m = 100.0;
  double most_m = 0.0;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const auto kind = static_cast<LayoutKind>(seed % kLayoutKinds);
    const Layout layout = drawn_layout(kind, 32.0, Random{seed});
    ASSERT_GE(layout.slots.size(), 2U) << name_of(kind) << " of seed " << seed;
    const Polyline& outline = std::get<Polyline>(layout.world.objects.front().shape);
    EXPECT_EQ(outline.points.front(), outline.points.back()) << "the outer wall is closed";
    for (const Object& object : layout.world.objects) {
      const Box* box = object.kind == ObjectKind::kContainer ? std::get_if<Box>(&object.shape) : nullptr;
      if (box == nullptr) continue;
      EXPECT_TRUE(stands_free(*box, object.id, layout.world)) << name_of(kind) << " of seed " << seed;
      least_m = std::min({least_m, box->width_m, box->height_m});
      most_m = std::max({most_m, box->width_m, box->height_m});
    }
  }
  EXPECT_NEAR(least_m, 0.4, 0.1);
  EXPECT_NEAR(most_m, 6.0, 0.5);
}

TEST(UnseenWorld, IsTheSameForTheSameSeedAndAnotherForAnother) {
  const auto drawn = [](std::uint64_t seed) { return unseen_world(unseen_kind(seed), seed); };
  for (const std::uint64_t seed : {3U, 4U}) {
    UnseenWorld one = drawn(seed);
    UnseenWorld other = drawn(seed);
    EXPECT_TRUE(same(one.drawn.scenario.world, other.drawn.scenario.world));
    EXPECT_EQ(all_cells(one.first_map), all_cells(other.first_map));
    VirtualDrive drive{one.drawn.scenario, one.drawn.drive};
    VirtualDrive again{other.drawn.scenario, other.drawn.drive};
    for (int scan = 0; scan < 200; ++scan) ASSERT_TRUE(same(drive.next(), again.next())) << "scan " << scan;
    EXPECT_FALSE(same(one.drawn.scenario.world, drawn(seed + 10).drawn.scenario.world));
  }
}

/// Of every layout: the robot gets about, people have a way, and a map out of date by a share is so.
TEST(UnseenWorld, CanBeDrivenInWhateverItsLayout) {
  for (std::uint64_t seed = 1; seed <= 2 * kLayoutKinds; ++seed) {
    UnseenKind kind = unseen_kind(seed);
    kind.layout = static_cast<LayoutKind>(seed % kLayoutKinds);
    kind.from_first_drive = false;
    kind.scan_period_s = 0.5;
    kind.speed_m_per_s = 0.6;
    kind.outdated_share = 0.3;
    const UnseenWorld unseen = unseen_world(kind, seed);
    VirtualDrive drive{unseen.drawn.scenario, unseen.drawn.drive};
    Point2 low = drive.map_from_robot().position();
    Point2 high = low;
    std::size_t changes = 0;
    for (int scan = 0; scan < 360; ++scan) {
      const DriveStep step = drive.next();
      low = low.cwiseMin(step.map_from_robot.position());
      high = high.cwiseMax(step.map_from_robot.position());
      changes += step.changes.size();
    }
    EXPECT_GT((high - low).norm(), 6.0) << name_of(kind.layout) << " of seed " << seed;
    EXPECT_GT(changes, unseen.drawn.scenario.slots.size() / 10) << name_of(kind.layout) << " of seed " << seed;
    EXPECT_GT(count_of(unseen.first_map, CellState::kFree), 2000U);
  }
}

TEST(UnseenWorld, ShowsMostOfTheFloorInTheMapOfAFirstDrive) {
  UnseenKind kind = unseen_kind(1);
  kind.layout = LayoutKind::kBentHall;
  kind.range_m = 32.0;
  kind.resolution_m = 0.1;
  const OccupancyGrid exact = unseen_world(kind, 1).first_map;
  kind.from_first_drive = true;
  const OccupancyGrid surveyed = unseen_world(kind, 1).first_map;
  ASSERT_EQ(exact.geometry(), surveyed.geometry());
  const auto share_kept = [&](CellState state) {
    double all = 0.0;
    double kept = 0.0;
    for_each_known(exact, [&](Cell cell, CellState is) {
      if (is != state) return;
      all += 1.0;
      kept += surveyed[cell] == state ? 1.0 : 0.0;
    });
    return kept / all;
  };
  EXPECT_GT(share_kept(CellState::kFree), 0.9);
  EXPECT_GT(share_kept(CellState::kOccupied), 0.5) << "within a cell for the rest";
  EXPECT_LT(share_kept(CellState::kOccupied), 0.999) << "it is noisy";
}

TEST(ShiftedHall, ShiftsOneContainerAMinuteByNoMoreThanItMay) {
  const Drawn drawn = shifted_hall({.range_m = 8.0, .crowd = true, .largest_turn_rad = radians(10.0)}, 5);
  EXPECT_EQ(drawn.scenario.slots.size(), 64U);
  EXPECT_EQ(drawn.scenario.people.size(), 12U);
  EXPECT_EQ(drawn.drive.changes_at_start.size(), 60U);
  VirtualDrive drive{drawn.scenario, drawn.drive};
  std::size_t shifts = 0;
  for (int scan = 0; scan < 5 * 60 * 10; ++scan) {
    for (const Change& change : drive.next().changes) {
      if (change.kind != ChangeKind::kShifted) continue;
      ++shifts;
      const auto home =
          std::min_element(drawn.scenario.slots.begin(), drawn.scenario.slots.end(), [&](const Box& a, const Box& b) {
            return (a.centre - change.box.centre).norm() < (b.centre - change.box.centre).norm();
          });
      EXPECT_LE((home->centre - change.box.centre).cwiseAbs().maxCoeff(), 0.8 + kTiny);
      EXPECT_LE(std::abs(change.box.theta_rad), radians(10.0) + kTiny);
    }
  }
  EXPECT_GE(shifts, 7U);
  EXPECT_LE(shifts, 10U);
}

}  // namespace
}  // namespace deltamap::simulation::drawn
